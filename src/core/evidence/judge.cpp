#include "self_awareness/core/evidence/judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/evidence/blame.h"
#include "core/evidence/busy_machine.h"
#include "core/evidence/hindsight.h"
#include "core/evidence/never_heard.h"
#include "core/evidence/scorer.h"
#include "core/evidence/strangers.h"

namespace self_awareness::core::evidence {
namespace {

// Above this share of its limit, the linker is suspicious.
constexpr double kSuspicious = 0.75;
// The score of a busy machine whose evidence is within all limits: just abnormal.
constexpr double kStillBusy = 1.01 * kThreshold;

class Judge : public core::Judge {
 public:
  Judge(std::shared_ptr<const Model> model, std::optional<Limits> limits, std::int64_t window,
        std::shared_ptr<const SourceGraph> graph, std::shared_ptr<const Vocabulary> heard,
        SharesHandler shares);

  ObservedEvent add(const Event& event) override {
    hindsight_.add(event);
    never_heard_.add(event);
    strangers_.add(event);
    return {event, !model_->knows(event.id), scorer_.add(event)};
  }
  void settle(const Event& first, std::int64_t settle_time) override;
  void leaveOut(const std::vector<EventId>& ids, std::int64_t until) override;
  Judgement judge(const Window& window, std::int64_t end, NameSuspects suspects) override;
  void restart() override;

 private:
  /// Takes back that there are too few events, in a window that ended with the recording.
  void leaveOutFewer(std::vector<double>& evidence) const;
  /// Takes back what the tracks say of event types that settle.
  void leaveOutNew(std::int64_t now, std::vector<double>& evidence) const;
  bool isSilent() const;
  /// The suspects of a window.
  /// @param silent_first whether those come before what was never heard that tracks speak against
  std::vector<Suspect> namedIn(const Window& window, bool silent_first) const;

  std::shared_ptr<const Model> model_;
  std::optional<Limits> limits_;
  std::int64_t window_;  // length of a whole one [ns]
  Scorer scorer_;
  Hindsight hindsight_;
  Blame blame_;
  NeverHeard never_heard_;
  Strangers strangers_;
  BusyMachine busy_machine_;
  std::int64_t settle_time_ = 0;  // [ns]
  std::vector<double> shares_;    // of its limit that each track has reached
  SharesHandler tell_shares_;
  std::vector<std::int64_t> settled_at_;                                    // [ns], by id
  std::int64_t all_settled_at_ = std::numeric_limits<std::int64_t>::min();  // the latest of them
};

Judge::Judge(std::shared_ptr<const Model> model, std::optional<Limits> limits, std::int64_t window,
             std::shared_ptr<const SourceGraph> graph, std::shared_ptr<const Vocabulary> heard,
             SharesHandler shares)
    : model_(std::move(model)),
      limits_(std::move(limits)),
      window_(window),
      scorer_(model_, window),
      hindsight_(model_),
      blame_(model_, graph),
      never_heard_(*model_, limits_.value_or(Limits{}), std::move(graph)),
      strangers_(*model_, std::move(heard)),
      busy_machine_(model_),
      shares_(model_->tracks().size(), 0),
      tell_shares_(std::move(shares)),
      settled_at_(model_->size(), std::numeric_limits<std::int64_t>::min()) {
  if (limits_ && (limits_->tracks.size() != model_->tracks().size() ||
                  !std::isfinite(limits_->linker) || limits_->linker <= 0)) {
    throw std::invalid_argument("the limits are not those of the model: calibrate it again");
  }
  if (limits_) {
    scorer_.capAt(*limits_);
  }
}

void Judge::settle(const Event& first, std::int64_t settle_time) {
  settle_time_ = settle_time;
  leaveOut({first.id}, first.stamp + settle_time);
}

void Judge::leaveOut(const std::vector<EventId>& ids, std::int64_t until) {
  for (const EventId id : ids) {
    if (model_->knows(id)) {
      settled_at_[id] = std::max(settled_at_[id], until);
      all_settled_at_ = std::max(all_settled_at_, settled_at_[id]);
    }
  }
}

void Judge::restart() {
  scorer_.restart();
  hindsight_.restart();
  never_heard_.restart();
  strangers_.restart();
  busy_machine_.restart();
  std::fill(settled_at_.begin(), settled_at_.end(), std::numeric_limits<std::int64_t>::min());
  all_settled_at_ = std::numeric_limits<std::int64_t>::min();
}

void Judge::leaveOutFewer(std::vector<double>& evidence) const {
  for (std::size_t track = 0; track < evidence.size(); ++track) {
    if (model_->tracks()[track].channel == Channel::kFewer) {
      evidence[track] = 0;
    }
  }
}

void Judge::leaveOutNew(std::int64_t now, std::vector<double>& evidence) const {
  if (now >= all_settled_at_) {
    return;
  }
  for (std::size_t track = 0; track < evidence.size(); ++track) {
    const auto& [channel, to, from] = model_->tracks()[track];
    if (now < std::max(settled_at_[to], settled_at_[from])) {
      evidence[track] = 0;
    }
  }
}

Judgement Judge::judge(const Window& window, std::int64_t end, NameSuspects suspects) {
  Judgement judgement;
  std::vector<double> evidence = scorer_.closeWindow(end);
  if (!limits_) {
    return judgement;
  }
  if (end < window.start + window_) {
    leaveOutFewer(evidence);
  }
  leaveOutNew(window.start, evidence);
  std::set<std::string> channels;
  for (std::size_t track = 0; track < evidence.size(); ++track) {
    const double share = evidence[track] / limits_->tracks[track];
    shares_[track] = std::isnan(share) ? 0 : share;
    if (shares_[track] > 1 && model_->tracks()[track].channel != Channel::kSlowDelay) {
      channels.insert(channelName(model_->tracks()[track].channel));
    }
  }
  const Sum sum = sumUp(evidence, *model_, *limits_);
  const double linker = model_->tuning().isOn("linker") ? sum.linker / limits_->linker : 0;
  never_heard_.closeWindow(end, settle_time_);
  if (tell_shares_) {
    tell_shares_(window, {shares_, linker, never_heard_.shares()});
  }
  judgement.score = -std::max({sum.largest, linker, never_heard_.share()});
  judgement.threshold = kThreshold;
  judgement.busy = busy_machine_.closeWindow(shares_, scorer_, *judgement.score < kThreshold);
  if (judgement.busy) {
    // An alarm lasts as long as its cause, though none of the sums may be beyond its limit now.
    judgement.score = std::min(*judgement.score, kStillBusy);
    channels.insert("busy");
  }
  judgement.abnormal = *judgement.score < kThreshold;
  judgement.certain = linker > 1 || never_heard_.share() > 1 || isSilent();
  judgement.suspicious = linker > kSuspicious || never_heard_.share() > 0;
  if (linker > kSuspicious) {
    channels.insert("linker");
  }
  if (never_heard_.share() > 0) {
    channels.insert("never heard");
  }
  for (const std::string& channel : channels) {
    judgement.evidence += (judgement.evidence.empty() ? "" : ", ") + channel;
  }
  if (suspects == NameSuspects::kAlways ||
      (suspects == NameSuspects::kIfUnusual && (judgement.abnormal || judgement.suspicious))) {
    judgement.suspects = namedIn(window, std::max(sum.largest, linker) > 1);
  }
  return judgement;
}

std::vector<Suspect> Judge::namedIn(const Window& window, bool silent_first) const {
  std::vector<Suspect> first = blame_.suspects(shares_, scorer_, hindsight_, window);
  std::vector<Suspect> second = never_heard_.suspects();
  if (!silent_first) {
    std::swap(first, second);
  }
  std::vector<Suspect> named = strangers_.suspects(window, scorer_);
  for (const std::vector<Suspect>& suspects : {first, second}) {
    for (const Suspect& suspect : suspects) {
      if (std::none_of(named.begin(), named.end(),
                       [&](const Suspect& other) { return other.id == suspect.id; })) {
        named.push_back(suspect);
      }
    }
  }
  return named;
}

bool Judge::isSilent() const {
  const std::vector<Track>& tracks = model_->tracks();
  const std::int64_t confirmation = toNanoseconds(model_->tuning().confirmation);
  for (std::size_t track = 0; track < tracks.size(); ++track) {
    const EventId id = tracks[track].to;
    if (tracks[track].channel == Channel::kOverdue && shares_[track] > 1 &&
        model_->overdue(id, scorer_.age(id) - confirmation) > limits_->tracks[track]) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::unique_ptr<core::Judge> makeJudge(std::shared_ptr<const Model> model,
                                       std::optional<Limits> limits, std::int64_t window,
                                       std::shared_ptr<const SourceGraph> graph,
                                       std::shared_ptr<const Vocabulary> heard,
                                       SharesHandler shares) {
  return std::make_unique<Judge>(std::move(model), std::move(limits), window, std::move(graph),
                                 std::move(heard), std::move(shares));
}

}  // namespace self_awareness::core::evidence
