#include "self_awareness/core/paper/judge.h"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "core/paper/blame.h"
#include "core/paper/scorer.h"

namespace self_awareness::core::paper {
namespace {

class Judge : public core::Judge {
 public:
  Judge(const std::shared_ptr<const Model>& model, std::optional<double> threshold,
        bool silence_is_abnormal)
      : threshold_(threshold),
        silence_is_abnormal_(silence_is_abnormal),
        scorer_(model),
        blame_(model) {
    if (threshold_ && !std::isfinite(*threshold_)) {
      throw std::invalid_argument("the threshold must be a finite number");
    }
  }

  ObservedEvent add(const Event& event) override {
    const Scorer::Scored scored = scorer_.score(event);
    scores_.push_back(scored.score);
    return scored.event;
  }

  Judgement judge(const Window& window, std::int64_t end, NameSuspects suspects) override {
    Judgement judgement;
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
  Scorer scorer_;
  Blame blame_;
  std::vector<double> scores_;  // of the events since the last window
};

}  // namespace

std::unique_ptr<core::Judge> makeJudge(const std::shared_ptr<const Model>& model,
                                       std::optional<double> threshold, bool silence_is_abnormal) {
  return std::make_unique<Judge>(model, threshold, silence_is_abnormal);
}

}  // namespace self_awareness::core::paper
