#include "self_awareness/core/verdict/detector.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace self_awareness::core {
namespace {

// What was missed, or came all at once afterwards, is in the counts of the last seconds for so
// long [ns].
constexpr std::int64_t kBacklog = 3 * kNanosecondsPerSecond;

// A load comes and goes: a machine that is busy now and then is one suspicion [ns].
constexpr std::int64_t kBusyHold = 10 * kNanosecondsPerSecond;

/// Whether somebody is a suspect for being there, or for not being there.
bool isOfPresence(const Suspect& suspect) {
  const Kind kind = suspect.reason.kind;
  return kind == Kind::kNeverCame || kind == Kind::kStranger || kind == Kind::kTwoSenders;
}

/// Makes a window suspicious.
void addEvidence(Judgement& judgement, const std::string& evidence) {
  judgement.evidence += (judgement.evidence.empty() ? "" : ", ") + evidence;
  judgement.suspicious = true;
}

}  // namespace

Detector::Detector(std::unique_ptr<Judge> judge, std::int64_t window, const Parameters& parameters,
                   Handler handler)
    : judge_(std::move(judge)),
      parameters_(parameters),
      handler_(std::move(handler)),
      windows_(window, *this),
      persistence_(parameters.persistence),
      new_mode_(parameters.persistence) {
  if (parameters_.settle_time < 0) {
    throw std::invalid_argument("settle_time must be 0 or more");
  }
}

bool Detector::add(const Event& event) {
  const bool first = !started();
  const bool same_clock = windows_.add(event);
  if (first || !same_clock) {
    settled_at_ = event.stamp + parameters_.settle_time;
  }
  return same_clock;
}

void Detector::accept(const Acceptances& accepted) {
  judge_->accept(accepted);
  for (auto each = unknown_.begin(); each != unknown_.end();) {
    each =
        judge_->isAccepted(each->first, Kind::kStranger) ? unknown_.erase(each) : std::next(each);
  }
  for (auto each = awaited_.begin(); each != awaited_.end();) {
    each = judge_->isAccepted(each->first, each->second.kind) ? awaited_.erase(each)
                                                              : std::next(each);
  }
}

void Detector::hear(const Waiting& waiting) {
  if (!waiting.stoodStill()) {
    judge_->hear(waiting);
    return;
  }
  const std::int64_t until = waiting.to + std::max(parameters_.settle_time, kBacklog);
  judge_->standStill(waiting, until);
  resumed_at_ = std::max(resumed_at_, until);
}

void Detector::onMissed(const std::vector<EventId>& ids, std::int64_t now) {
  judge_->leaveOut(ids, now + std::max(parameters_.settle_time, kBacklog));
}

void Detector::advance(std::int64_t now) {
  windows_.advance(now);
}

void Detector::finish() {
  windows_.finish();
}

void Detector::restart() {
  windows_.restart();
  onClockStep();
}

void Detector::onClockStep() {
  judge_->restart();
  resumed_at_ = 0;
  heard_.clear();
  unknown_.clear();
  clearAlarm();
}

void Detector::clearAlarm() {
  persistence_.clear();
  new_mode_.clear();
  resumed_ = false;
  awaited_.clear();
  suspicion_ = false;
  suspicious_until_ = 0;
  silent_ = 0;
  named_.clear();
}

void Detector::resume(const std::vector<Suspect>& suspects) {
  resumed_ = true;
  persistence_.raise(0);
  for (const Suspect& suspect : suspects) {
    named_.emplace(std::pair(suspect.component, suspect.component.empty() ? suspect.id : 0),
                   suspect.since);
    const Kind kind = suspect.reason.kind;
    if (isMissing(kind) && !judge_->isAccepted(suspect.id, kind)) {
      awaited_[suspect.id].kind = kind;
    }
  }
}

bool Detector::awaitsSuspects(std::int64_t end) const {
  const std::int64_t long_enough =
      std::max(parameters_.settle_time, parameters_.persistence.alarm_of * windows_.length());
  return std::any_of(awaited_.begin(), awaited_.end(), [&](const auto& awaited) {
    const std::optional<std::int64_t>& heard = awaited.second.heard;
    return !heard || end - *heard < long_enough;
  });
}

std::optional<ObservedEvent> Detector::observe(const Event& event) {
  if (event.id >= heard_.size()) {
    heard_.resize(event.id + 1, false);
  }
  if (!heard_[event.id]) {
    heard_[event.id] = true;
    judge_->settle(event, parameters_.settle_time);
    if (const auto awaited = awaited_.find(event.id); awaited != awaited_.end()) {
      awaited->second.heard = event.stamp;
    }
  }
  const std::optional<ObservedEvent> observed = judge_->add(event);
  if (observed && observed->unknown) {
    ++unknown_[event.id].events;
  }
  return observed;
}

std::map<EventId, std::uint64_t> Detector::unknown() const {
  std::map<EventId, std::uint64_t> events;
  for (const auto& [id, unknown] : unknown_) {
    events[id] = unknown.events;
  }
  return events;
}

bool Detector::isNews(const Window& window) const {
  if (parameters_.unknown == UnknownEvents::kIgnore) {
    return false;
  }
  return std::any_of(window.events.begin(), window.events.end(), [&](const ObservedEvent& each) {
    const auto unknown = each.unknown ? unknown_.find(each.event.id) : unknown_.end();
    return unknown != unknown_.end() &&  // else it was accepted since it came
           (parameters_.unknown == UnknownEvents::kError || !unknown->second.told);
  });
}

void Detector::tellOnce(const Window& window) {
  for (const ObservedEvent& each : window.events) {
    const auto unknown = each.unknown ? unknown_.find(each.event.id) : unknown_.end();
    if (unknown != unknown_.end()) {
      unknown->second.told = true;
    }
  }
}

void Detector::close(const Window& window, std::int64_t end) {
  const std::int64_t window_end = window.start + windows_.length();
  const bool starting = window.start < settled_at_;
  const bool unknown = isNews(window);
  Judgement judgement = judge_->judge(window, end,
                                      starting  ? NameSuspects::kNever
                                      : unknown ? NameSuspects::kAlways
                                                : NameSuspects::kIfUnusual);
  if (unknown) {
    addEvidence(judgement, kUnknownEvents);
  }
  if (unknown && parameters_.unknown == UnknownEvents::kError && judgement.threshold) {
    judgement.abnormal = true;
    judgement.certain = true;
  }

  Verdict verdict;
  verdict.window = &window;
  verdict.score = judgement.score;
  verdict.threshold = judgement.threshold;
  verdict.abnormal = judgement.abnormal;
  const bool stood = persistence_.raised();
  // What is new raises no alarm, but one that stands goes on as long as its cause does; after a
  // pause, which hides that, for a while.
  verdict.settling = starting || (stood ? window.start < resumed_at_ : judgement.settling);
  const bool was_suspicion = suspicion_;
  if (verdict.settling) {
    verdict.alarm = persistence_.leaveOut(windows_.length());
    new_mode_.leaveOut(windows_.length());
    suspicious_until_ += windows_.length();
  } else {
    leaveOutShortStops(judgement, window_end);
    verdict.evidence = judgement.evidence;
    verdict.busy = judgement.busy;
    verdict.silent = std::move(judgement.silent);
    verdict.mode = std::move(judgement.mode);
    verdict.suspects = std::move(judgement.suspects);
    verdict.waiting = std::move(judgement.waiting);
    count(judgement, window_end);
    verdict.alarm = persistence_.raised();
    tellOnce(window);
  }
  resumed_ = resumed_ && (starting || awaitsSuspects(window_end));
  if (resumed_) {
    persistence_.raise(window_end);
    verdict.alarm = true;
  }
  verdict.suspicion = suspicion_ && !verdict.alarm;
  verdict.changed = verdict.alarm != stood || verdict.suspicion != (was_suspicion && !stood);
  if (verdict.changed) {
    named_.clear();
    silent_ = 0;
  }
  const std::vector<Suspect> named_first = name(verdict.suspects, verdict.changed, window_end);
  // Who is new, or missing, is told once only: not even a suspicion that stands may swallow it.
  const bool is_news =
      unknown || std::any_of(named_first.begin(), named_first.end(),
                             [](const Suspect& each) { return isOfPresence(each); });
  if ((verdict.alarm || (verdict.suspicion && is_news)) && !verdict.changed &&
      !named_first.empty()) {
    verdict.new_suspects = named_first;
    verdict.changed = true;
  }
  if (verdict.alarm && verdict.silent && verdict.silent->components.size() > silent_) {
    silent_ = verdict.silent->components.size();
    verdict.changed = true;
  }
  verdict.suspects.resize(std::min(verdict.suspects.size(), kMostSuspects));
  handler_(verdict);
}

std::vector<Suspect> Detector::name(std::vector<Suspect>& suspects, bool begins,
                                    std::int64_t end) {
  std::vector<Suspect> named_first;
  for (Suspect& suspect : suspects) {
    const std::pair<std::string, EventId> owner(suspect.component,
                                                suspect.component.empty() ? suspect.id : 0);
    const auto named = named_.find(owner);
    suspect.since = named == named_.end() ? end : named->second;
    if (named == named_.end() && (begins || suspect.abnormal || isOfPresence(suspect))) {
      named_.emplace(owner, end);
      named_first.push_back(suspect);
    }
  }
  return named_first;
}

void Detector::leaveOutShortStops(Judgement& judgement, std::int64_t end) {
  const bool stopped = judgement.silent && judgement.silent->others_go_on;
  const bool lasts = new_mode_.add(stopped, end, false);
  if (stopped && lasts) {
    addEvidence(judgement, "new mode");
  } else if (stopped) {
    judgement.silent.reset();
  }
}

void Detector::count(const Judgement& judgement, std::int64_t end) {
  persistence_.add(judgement.abnormal, end, judgement.abnormal && judgement.certain);
  if (judgement.threshold && (judgement.abnormal || judgement.suspicious)) {
    suspicion_ = true;
    const std::int64_t hold = parameters_.persistence.hold_time;
    const bool flaps = judgement.busy && !persistence_.raised();
    suspicious_until_ =
        std::max(suspicious_until_, end + (flaps ? std::max(hold, kBusyHold) : hold));
  } else if (end >= suspicious_until_) {
    suspicion_ = false;
  }
}

}  // namespace self_awareness::core
