#include "self_awareness/core/evidence/judge.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/evidence/channel/scorer.h"
#include "core/evidence/excuse/accepted.h"
#include "core/evidence/excuse/excuses.h"
#include "core/evidence/excuse/settling.h"
#include "core/evidence/explain/causes.h"
#include "core/evidence/explain/excess.h"
#include "core/evidence/explain/explanation.h"
#include "core/evidence/presence/never_heard.h"
#include "core/evidence/presence/unsubscribed.h"
#include "core/evidence/presence/who_sends.h"
#include "self_awareness/core/verdict/dependents.h"

namespace self_awareness::core::evidence {
namespace {

// The score of a busy machine whose evidence is within all limits: just abnormal.
constexpr double kStillBusy = 1.01 * kThreshold;

double largestOf(const std::vector<double>& shares) {
  if (shares.empty()) {
    return 0;
  }
  // By vectors of the processor: every window needs it.
  const auto size = static_cast<Eigen::Index>(shares.size());
  return Eigen::Map<const Eigen::ArrayXd>(shares.data(), size).maxCoeff();
}

/// The limits of silence, by event type; NaN: it is not judged.
std::vector<double> ofSilence(const Model& model, const Limits& limits) {
  std::vector<double> of_silence(model.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t track = 0; track < limits.tracks.size(); ++track) {
    if (model.finding(track) == Finding::kSilent) {
      of_silence[model.tracks()[track].to] = limits.tracks[track];
    }
  }
  return of_silence;
}

class Judge : public core::Judge {
 public:
  Judge(std::shared_ptr<const Model> model, std::optional<Limits> limits, std::int64_t window,
        std::shared_ptr<const SourceGraph> graph, std::shared_ptr<const Vocabulary> heard,
        SharesHandler shares);

  std::optional<ObservedEvent> add(const Event& event) override {
    never_heard_.add(event);
    if (model_->vocabulary().tellsMode(event.id) || (heard_ && heard_->tellsMode(event.id))) {
      scorer_.enter(event);  // one that training never saw is no stranger
      return std::nullopt;
    }
    if (!model_->vocabulary().isMessage(event.id) || (heard_ && !heard_->isMessage(event.id))) {
      who_sends_.addList(event, accepted_);
      return std::nullopt;
    }
    const bool unknown = who_sends_.add(event, accepted_);
    const std::optional<std::int64_t> gap = scorer_.add(event);
    if (model_->knows(event.id)) {
      events_.add(event, scorer_.stalled());
      if (gap && accepted_.isBack(event.id, *gap)) {
        settling_.cover(event.id, event.stamp + settle_time_);
      }
    }
    return ObservedEvent{event, unknown, gap};
  }
  std::optional<LastingMode> mode(std::int64_t now) const override {
    return scorer_.heard().lasting(now);
  }
  std::vector<WatchedLess> watchedLess() const override;
  void hear(const Waiting& waiting) override { scorer_.hear(waiting); }
  void standStill(const Waiting& pause, std::int64_t until) override;
  void accept(const Acceptances& accepted) override {
    accepted_.accept(accepted);
    unsubscribed_.accept(accepted);
    excuses_.accept(accepted);
  }
  bool isAccepted(EventId id, Kind kind) const override { return accepted_.isExcused(id, kind); }
  void setMissing(const std::set<SourceGraph::Subscription>& missing) override {
    unsubscribed_.set(missing);
  }
  void setSenders(const Senders& senders) override { who_sends_.set(senders); }
  void settle(const Event& first, std::int64_t settle_time) override;
  void leaveOut(const std::vector<EventId>& ids, std::int64_t until) override;
  Judgement judge(const Window& window, std::int64_t end, NameSuspects suspects) override;
  void restart() override;

 private:
  /// Finds the shares of a window by the evidence, without what is not judged now.
  void weigh(std::vector<double>& evidence);
  /// Finds what is unusual, and excuses what is no fault of the component. Takes back the shares
  /// of what is normal, and tells what is left of them, but for a mode that training never saw.
  void excuse(const Window& window, std::int64_t end, Judgement& judgement);
  /// Takes back the shares of what has an excuse.
  void takeBack(Excused reason);
  /// Excuses who does not come, or is unusual, because of who sends.
  void excuseBySenders(const Window& window);
  /// The channels that speak against somebody, as Judgement::evidence.
  /// @param judgement with what excuses say
  std::string evidenceOf(const Judgement& judgement) const;
  /// Whether anything is unusual that is not accepted.
  bool isUnusual() const;
  /// Whether a track beyond its limit is so beyond all doubt.
  bool isCertain() const;
  /// Who of the suspects waits for the first one, if that is silent; empty: nobody.
  std::string waitingIn(const std::vector<Suspect>& suspects) const;
  /// What is unusual in the last window.
  Unusual unusual() const {
    return {*unusual_,
            scorer_,
            events_,
            causes_,
            limits_of_silence_,
            strangers_,
            accepted_.mayBeSilent()};
  }
  /// The suspects of a window with evidence of known event types.
  /// @param silent_first whether those come before what was never heard that tracks speak against,
  /// and that does not wait for its messages
  std::vector<Suspect> namedIn(const Window& window, bool silent_first) const;

  std::shared_ptr<const Model> model_;
  std::optional<Limits> limits_;
  std::vector<double> limits_of_silence_;    // by id; none: as long as there are no limits
  std::int64_t window_;                      // length of a whole one [ns]
  std::shared_ptr<const Vocabulary> heard_;  // event types by id; null: those of the model
  std::shared_ptr<const SourceGraph> graph_;
  Scorer scorer_;
  RecentEvents events_;
  std::shared_ptr<const Upstream> upstream_;
  Causes causes_;
  Explanation explanation_;
  NeverHeard never_heard_;
  WhoSends who_sends_;
  Unsubscribed unsubscribed_;
  Accepted accepted_;
  Settling settling_;
  Excuses excuses_;
  std::int64_t settle_time_ = 0;  // [ns]
  std::vector<double> shares_;    // of its limit that each track has reached
  SharesHandler tell_shares_;
  Excesses excesses_;
  // Of the last window:
  std::vector<Excess>* unusual_ = nullptr;
  std::map<std::string, std::int64_t> strangers_;  // as Unusual has them
};

Judge::Judge(std::shared_ptr<const Model> model, std::optional<Limits> limits, std::int64_t window,
             std::shared_ptr<const SourceGraph> graph, std::shared_ptr<const Vocabulary> heard,
             SharesHandler shares)
    : model_(std::move(model)),
      limits_(std::move(limits)),
      window_(window),
      heard_(heard),
      graph_(std::move(graph)),
      scorer_(model_, window),
      events_(model_->size()),
      upstream_(std::make_shared<Upstream>(model_->components(), graph_)),
      causes_(model_, upstream_),
      explanation_(model_),
      never_heard_(*model_, limits_.value_or(Limits{}), upstream_),
      who_sends_(model_, heard, graph_, never_heard_.expected()),
      unsubscribed_(*model_),
      accepted_(model_, std::move(heard)),
      settling_(model_),
      excuses_(model_, allExcuses(model_, graph_)),
      shares_(model_->tracks().size(), 0),
      tell_shares_(std::move(shares)),
      excesses_(model_) {
  if (limits_ && limits_->tracks.size() != model_->tracks().size()) {
    throw std::invalid_argument("the limits are not those of the model: calibrate it again");
  }
  if (limits_) {
    scorer_.capAt(*limits_);
    limits_of_silence_ = ofSilence(*model_, *limits_);
  }
}

void Judge::settle(const Event& first, std::int64_t settle_time) {
  settle_time_ = settle_time;
  settling_.cover(first.id, first.stamp + settle_time);
}

void Judge::leaveOut(const std::vector<EventId>& ids, std::int64_t until) {
  for (const EventId id : ids) {
    settling_.cover(id, until);
    if (model_->vocabulary().tellsMode(id)) {
      scorer_.loseMode();  // another one may have been told
    }
  }
}

void Judge::standStill(const Waiting& pause, std::int64_t until) {
  scorer_.hear(pause);
  never_heard_.leaveOut(pause.waited);
  settling_.coverAll(until);
}

void Judge::restart() {
  scorer_.restart();
  events_.restart();
  never_heard_.restart();
  who_sends_.restart();
  unsubscribed_.restart();
  settling_.restart();
  excuses_.restart();
  excesses_.restart();
}

Judgement Judge::judge(const Window& window, std::int64_t end, NameSuspects suspects) {
  Judgement judgement;
  settling_.forgetStarts(window.start, scorer_);
  std::vector<double>& evidence = scorer_.closeWindow(end);
  if (!limits_) {
    return judgement;
  }
  excuseBySenders(window);
  weigh(evidence);
  never_heard_.closeWindow(end, settle_time_);
  unsubscribed_.closeWindow(end);
  excuse(window, end, judgement);
  const double largest = largestOf(shares_);
  judgement.score = -std::max(largest, never_heard_.share());
  judgement.threshold = kThreshold;
  if (who_sends_.isAbnormal() ||
      (judgement.busy && ((judgement.busy->late > 0 && isUnusual()) ||
                          judgement.busy->starved > model_->tuning().accept_after))) {
    // An alarm lasts as long as its cause, though none of the sums may be beyond its limit now.
    judgement.score = std::min(*judgement.score, kStillBusy);
  }
  judgement.abnormal = *judgement.score < kThreshold;
  judgement.certain = never_heard_.share() > 1 || (largest > 1 && isCertain());
  judgement.suspicious = never_heard_.share() > 0 || unsubscribed_.any() || judgement.busy ||
                         !who_sends_.evidence().empty() || !judgement.suspects.empty();
  judgement.evidence = evidenceOf(judgement);
  const std::vector<Suspect> told = std::exchange(judgement.suspects, {});
  const bool somebody = largest > 1 || never_heard_.share() > 0 || unsubscribed_.any() ||
                        (judgement.busy && judgement.busy->late > 0);
  if (suspects != NameSuspects::kNever && somebody) {
    judgement.suspects = namedIn(window, largest > 1);
  } else if (suspects == NameSuspects::kAlways ||
             (suspects != NameSuspects::kNever && !who_sends_.evidence().empty())) {
    // Who is within his own range is no suspect because somebody else is unknown.
    judgement.suspects = who_sends_.alone(window, scorer_, suspects == NameSuspects::kAlways);
  }
  for (const Suspect& each : told) {
    const bool is_named =
        std::any_of(judgement.suspects.begin(), judgement.suspects.end(),
                    [&](const Suspect& named) { return named.component == each.component; });
    if (suspects != NameSuspects::kNever && !is_named) {
      judgement.suspects.push_back(each);
    }
  }
  accepted_.leaveOut(judgement.suspects);
  judgement.waiting = waitingIn(judgement.suspects);
  return judgement;
}

std::string Judge::waitingIn(const std::vector<Suspect>& suspects) const {
  if (suspects.empty() || !isSilence(suspects.front().reason.kind)) {
    return "";
  }
  std::set<std::string> silent;
  for (const Suspect& suspect : suspects) {
    if (suspect.abnormal && isAbsence(suspect.reason.kind)) {
      silent.insert(suspect.component);
    }
  }
  return waitingFor(*graph_, suspects.front().component, silent);
}

void Judge::excuseBySenders(const Window& window) {
  who_sends_.closeWindow(scorer_.heard(), accepted_);
  never_heard_.excuse(who_sends_.needNotCome(accepted_.mayBeSilent()));
  for (const EventId id : who_sends_.doubled()) {
    settling_.cover(id, window.start + window_ + settle_time_);
  }
}

void Judge::weigh(std::vector<double>& evidence) {
  settling_.leaveOut(evidence);
  accepted_.leaveOut(scorer_.heard(), evidence);
  for (std::size_t track = 0; track < evidence.size(); ++track) {
    // Most tracks say nothing most of the time, and a division takes its time.
    const bool counts = evidence[track] > 0 &&
                        !who_sends_.explains(model_->tracks()[track].to, model_->finding(track));
    const double share = counts ? evidence[track] / limits_->tracks[track] : 0;
    shares_[track] = std::isnan(share) ? 0 : share;
  }
}

void Judge::excuse(const Window& window, std::int64_t end, Judgement& judgement) {
  unusual_ = &excesses_.closeWindow(shares_, scorer_);
  causes_.closeWindow(*unusual_);
  strangers_ = who_sends_.silences(end);
  excuses_.closeWindow(*unusual_, unusual(), judgement);
  takeBack(Excused::kAccepted);
  if (tell_shares_) {
    tell_shares_(window, {shares_, never_heard_.shares()});
  }
  takeBack(Excused::kNewMode);
  takeBack(Excused::kSlowerClock);
}

void Judge::takeBack(Excused reason) {
  for (const Excess& excess : *unusual_) {
    if (excess.excused == reason) {
      shares_[excess.track] = 0;
    }
  }
}

std::vector<WatchedLess> Judge::watchedLess() const {
  std::vector<WatchedLess> less;
  for (std::size_t track = 0; limits_ && track < model_->tracks().size(); ++track) {
    const double raised_by = scorer_.raisedBy(track);
    if (!std::isnan(limits_->tracks[track]) && raised_by > 0) {
      less.push_back({model_->tracks()[track].to, model_->tracks()[track].from,
                      limits_->tracks[track] + raised_by});
    }
  }
  return less;
}

std::string Judge::evidenceOf(const Judgement& judgement) const {
  std::set<std::string> channels = who_sends_.evidence();
  for (std::size_t track = 0; track < shares_.size(); ++track) {
    if (shares_[track] > 1) {
      channels.insert(channelLabel(model_->tracks()[track]));
    }
  }
  if (judgement.busy) {
    channels.insert("busy");
  }
  if (!judgement.suspects.empty()) {
    channels.insert("clock");
  }
  if (never_heard_.share() > 0) {
    channels.insert("never heard");
  }
  if (unsubscribed_.any()) {
    channels.insert("connections");
  }
  std::string evidence;
  for (const std::string& channel : channels) {
    evidence += (evidence.empty() ? "" : ", ") + channel;
  }
  return evidence;
}

std::vector<Suspect> Judge::namedIn(const Window& window, bool silent_first) const {
  std::vector<Suspect> first = explanation_.suspects(unusual());
  // Who was there long before is not why something is unusual now.
  const std::int64_t since =
      first.empty() ? std::numeric_limits<std::int64_t>::min() : first.front().onset - kOneCause;
  who_sends_.addUnknown(window, since, first);
  who_sends_.dropMovers(first);
  std::vector<Suspect> second = never_heard_.suspects();
  if (!silent_first || (!first.empty() && never_heard_.isMissedBy(first.front().id))) {
    std::swap(first, second);
  }
  std::vector<Suspect> named;
  const auto add = [&](const Suspect& suspect) {
    if (std::none_of(named.begin(), named.end(),
                     [&](const Suspect& other) { return other.id == suspect.id; })) {
      named.push_back(suspect);
    }
  };
  // A stranger explains what is unusual, but for a death. Many do not hide who is to blame.
  const auto died = [](const Suspect& suspect) { return isAbsence(suspect.reason.kind); };
  if (!first.empty() && died(first.front()) &&
      std::any_of(first.begin(), first.end(),
                  [&](const Suspect& suspect) { return suspect.abnormal && died(suspect); })) {
    add(first.front());
  }
  const std::vector<Suspect> causes =
      who_sends_.causes(window, scorer_, since, first.empty() ? Suspect() : first.front());
  std::for_each(causes.begin(), causes.end(), add);
  // Who does not subscribe says what it always says: that explains nothing beyond a limit.
  const std::vector<Suspect>& deaf = unsubscribed_.suspects();
  const std::vector<Suspect> strangers = who_sends_.strangers(window, scorer_, since);
  const std::vector<Suspect> moved = who_sends_.movers();
  using Order = std::array<const std::vector<Suspect>*, 5>;
  const Order order = silent_first ? Order{&first, &second, &strangers, &deaf, &moved}
                                   : Order{&first, &moved, &deaf, &second, &strangers};
  for (const std::vector<Suspect>* suspects : order) {
    std::for_each(suspects->begin(), suspects->end(), add);
  }
  return named;
}

bool Judge::isUnusual() const {
  return std::any_of(unusual_->begin(), unusual_->end(),
                     [](const Excess& excess) { return excess.excused != Excused::kAccepted; });
}

bool Judge::isCertain() const {
  for (std::size_t track = 0; track < shares_.size(); ++track) {
    if (shares_[track] > 1 && scorer_.isCertain(track, limits_->tracks[track])) {
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
