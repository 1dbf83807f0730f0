#include "self_awareness/core/verdict/detector.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace self_awareness::core {

void Detector::Parameters::validate() const {
  persistence.validate();
  if (settle_time < 0) {
    throw std::invalid_argument("settle_time must be 0 or more");
  }
}

Detector::Detector(std::unique_ptr<Judge> judge, std::int64_t window, const Parameters& parameters,
                   Handler handler)
    : judge_(std::move(judge)),
      parameters_(parameters),
      handler_(std::move(handler)),
      windows_(window, *this),
      persistence_(parameters.persistence) {
  parameters_.validate();
}

bool Detector::add(const Event& event) {
  const bool first = !started();
  const bool same_clock = windows_.add(event);
  if (first || !same_clock) {
    settle(event.stamp);
  }
  return same_clock;
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
  clearAlarm();
}

void Detector::settle(std::int64_t now) {
  settled_at_ = now + parameters_.settle_time;
}

void Detector::clearAlarm() {
  persistence_.clear();
  suspicion_ = false;
}

void Detector::close(const Window& window, std::int64_t end) {
  const std::int64_t window_end = window.start + windows_.length();
  const bool settling = window.start < settled_at_;
  const bool unknown = window.unknown() > 0 && parameters_.unknown != UnknownEvents::kIgnore;
  Judgement judgement = judge_->judge(window, end,
                                      settling  ? NameSuspects::kNever
                                      : unknown ? NameSuspects::kAlways
                                                : NameSuspects::kIfUnusual);
  if (unknown) {
    judgement.evidence += (judgement.evidence.empty() ? "" : ", ") + std::string("unknown events");
    judgement.suspicious = true;
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
  verdict.settling = settling;
  verdict.evidence = judgement.evidence;
  verdict.suspects = std::move(judgement.suspects);
  const bool counts = verdict.abnormal && !settling;
  const bool stood = persistence_.raised();
  const bool was_suspicion = suspicion_;
  verdict.alarm = persistence_.add(counts, window_end, counts && judgement.certain);
  if (judgement.threshold && !settling && (counts || judgement.suspicious)) {
    suspicion_ = true;
    suspicious_at_ = window_end;
  } else if (window_end - suspicious_at_ >= parameters_.persistence.hold_time) {
    suspicion_ = false;
  }
  verdict.suspicion = suspicion_ && !verdict.alarm;
  verdict.changed = verdict.alarm != stood || verdict.suspicion != (was_suspicion && !stood);
  handler_(verdict);
}

}  // namespace self_awareness::core
