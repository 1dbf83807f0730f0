#include "self_awareness/core/verdict/detector.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "self_awareness/core/stream/clock.h"

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
      windows_(window, [this](const Window& closed) { this->judge(closed); }),
      persistence_(parameters.persistence) {
  parameters_.validate();
}

bool Detector::add(const Event& event) {
  const bool clock_step = last_stamp_ && isClockStep(*last_stamp_, event.stamp);
  if (clock_step) {
    restart();
  }
  if (!last_stamp_) {
    settle(event.stamp);
  }
  last_stamp_ = event.stamp;
  now_ = std::max(now_, event.stamp);
  windows_.advance(event.stamp);  // the windows before it are judged without it
  windows_.add(judge_->add(event));
  return !clock_step;
}

void Detector::advance(std::int64_t now) {
  now_ = std::max(now_, now);
  windows_.advance(now);
}

void Detector::finish() {
  windows_.finish();
}

void Detector::restart() {
  judge_->restart();
  windows_.restart();
  clearAlarm();
  last_stamp_.reset();
  now_ = std::numeric_limits<std::int64_t>::min();
}

void Detector::settle(std::int64_t now) {
  settled_at_ = now + parameters_.settle_time;
}

void Detector::clearAlarm() {
  persistence_.clear();
  suspicion_ = false;
}

void Detector::judge(const Window& window) {
  const std::int64_t end = window.start + windows_.length();
  // A recording may end within its last window: nobody knows what would have come.
  const std::int64_t known = std::min(end, now_);
  Judgement judgement = judge_->judge(window, known);
  const bool unknown = window.unknown() > 0;
  if (unknown && parameters_.unknown != UnknownEvents::kIgnore) {
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
  verdict.settling = window.start < settled_at_;
  verdict.evidence = judgement.evidence;
  const bool counts = verdict.abnormal && !verdict.settling;
  const bool stood = persistence_.raised();
  const bool was_suspicion = suspicion_;
  verdict.alarm = persistence_.add(counts, end, counts && judgement.certain);
  if (judgement.threshold && !verdict.settling && (counts || judgement.suspicious)) {
    suspicion_ = true;
    suspicious_at_ = end;
    verdict.suspects = judge_->suspects(window, known);
  } else if (end - suspicious_at_ >= parameters_.persistence.hold_time) {
    suspicion_ = false;
  }
  verdict.suspicion = suspicion_ && !verdict.alarm;
  verdict.changed = verdict.alarm != stood || verdict.suspicion != (was_suspicion && !stood);
  handler_(verdict);
}

}  // namespace self_awareness::core
