#include "self_awareness/core/paper/judge.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/paper/blame.h"
#include "core/paper/scorer.h"

namespace self_awareness::core::paper {
namespace {

class Judge : public core::Judge {
 public:
  Judge(const std::shared_ptr<const Model>& model, std::optional<double> threshold,
        bool silence_is_abnormal, std::shared_ptr<const Vocabulary> heard)
      : threshold_(threshold),
        silence_is_abnormal_(silence_is_abnormal),
        model_(model),
        heard_types_(std::move(heard)),
        scorer_(model),
        blame_(model) {
    if (threshold_ && !std::isfinite(*threshold_)) {
      throw std::invalid_argument("the threshold must be a finite number");
    }
  }

  std::optional<ObservedEvent> add(const Event& event) override {
    if (!model_->vocabulary().isMessage(event.id) ||
        (heard_types_ && !heard_types_->isMessage(event.id))) {
      return std::nullopt;  // the paper knows no modes, and nothing without delays
    }
    const Scorer::Scored scored = scorer_.score(event);
    scores_.push_back(scored.score);
    return scored.event;
  }

  // The score is that of the whole window, and delays since what is new take part in it. A topic
  // that a known component is heard on for the first time says too little: many are rare.
  void settle(const Event& first, std::int64_t settle_time) override {
    const std::int64_t settled = first.stamp + settle_time;
    if (!start_settled_at_) {
      start_settled_at_ = settled;
    }
    if (first.id < model_->size()) {
      const EventType& type = model_->vocabulary().at(first.id);
      const bool is_new = heard_.insert(componentOf(type.source, type.scope)).second;
      if (is_new && first.stamp >= *start_settled_at_) {
        settled_at_ = settled;
      }
    }
  }

  void leaveOut(const std::vector<EventId>& ids, std::int64_t until) override {
    if (std::any_of(ids.begin(), ids.end(), [&](EventId id) { return id < model_->size(); })) {
      settled_at_ = std::max(settled_at_.value_or(until), until);
    }
  }

  // One score for all does not tell who was silent before.
  void standStill(const Waiting& /*pause*/, std::int64_t until) override {
    settled_at_ = std::max(settled_at_.value_or(until), until);
  }

  Judgement judge(const Window& window, std::int64_t end, NameSuspects suspects) override {
    Judgement judgement;
    judgement.settling = settled_at_ && window.start < *settled_at_;
    judgement.score = windowScore();
    judgement.threshold = threshold_;
    if (threshold_) {
      judgement.abnormal = judgement.score ? *judgement.score < *threshold_
                                           : silence_is_abnormal_ && 0 < *threshold_;
    }
    if (judgement.abnormal) {
      judgement.evidence = judgement.score ? "score" : "silence";
    }
    if (threshold_ && (suspects == NameSuspects::kAlways ||
                       (suspects == NameSuspects::kIfUnusual && judgement.abnormal))) {
      judgement.suspects = blame_.suspects(window, scores_, scorer_.lastSeen(), end);
    }
    scores_.clear();
    return judgement;
  }

  void restart() override {
    scorer_.restart();
    scores_.clear();
    heard_.clear();
    start_settled_at_.reset();
    settled_at_.reset();
  }

 private:
  /// Eq. 2: the mean over the events of the open window; none without events (0/0).
  std::optional<double> windowScore() const {
    if (scores_.empty()) {
      return std::nullopt;
    }
    return std::accumulate(scores_.begin(), scores_.end(), 0.0) /
           static_cast<double>(scores_.size());
  }

  std::optional<double> threshold_;
  bool silence_is_abnormal_;
  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Vocabulary> heard_types_;  // by id; null: those of the model
  Scorer scorer_;
  Blame blame_;
  std::vector<double> scores_;                    // of the events since the last window
  std::set<std::string> heard_;                   // components, since the start
  std::optional<std::int64_t> start_settled_at_;  // [ns]; none: nothing was heard
  std::optional<std::int64_t> settled_at_;        // of what is new or was missed [ns]
};

}  // namespace

std::unique_ptr<core::Judge> makeJudge(const std::shared_ptr<const Model>& model,
                                       std::optional<double> threshold, bool silence_is_abnormal,
                                       std::shared_ptr<const Vocabulary> heard) {
  return std::make_unique<Judge>(model, threshold, silence_is_abnormal, std::move(heard));
}

}  // namespace self_awareness::core::paper
