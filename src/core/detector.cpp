#include "self_awareness/core/detector.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "self_awareness/core/clock.h"

namespace self_awareness::core {

void Detector::Parameters::validate() const {
  persistence.validate();
  if (settle_time < 0) {
    throw std::invalid_argument("settle_time must be 0 or more");
  }
}

Detector::Detector(std::shared_ptr<const Model> model, std::int64_t window,
                   std::optional<double> threshold, const Parameters& parameters, Handler handler)
    : threshold_(threshold),
      parameters_(parameters),
      handler_(std::move(handler)),
      scorer_(model),
      windows_(window, [this](const Window& closed) { judge(closed); }),
      persistence_(parameters.persistence),
      blame_(std::move(model)) {
  parameters_.validate();
  if (threshold_ && !std::isfinite(*threshold_)) {
    throw std::invalid_argument("the threshold must be a finite number");
  }
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
  windows_.advance(event.stamp);  // the windows before it are judged without it
  windows_.add(scorer_.score(event));
  return !clock_step;
}

void Detector::advance(std::int64_t now) {
  windows_.advance(now);
}

void Detector::finish() {
  windows_.finish();
}

void Detector::restart() {
  scorer_.restart();
  windows_.restart();
  persistence_.clear();
  last_stamp_.reset();
}

void Detector::settle(std::int64_t now) {
  settled_at_ = now + parameters_.settle_time;
}

void Detector::judge(const Window& window) {
  const std::int64_t end = window.start + windows_.length();
  Verdict verdict;
  verdict.window = &window;
  verdict.score = window.score();
  verdict.threshold = threshold_;
  if (threshold_) {
    verdict.abnormal = verdict.score ? *verdict.score < *threshold_
                                     : parameters_.silence_is_abnormal && 0 < *threshold_;
  }
  verdict.settling = window.start < settled_at_;
  const bool counts = verdict.abnormal && !verdict.settling;
  const bool before = persistence_.raised();
  verdict.alarm = persistence_.add(counts, end);
  verdict.changed = verdict.alarm != before;
  if (counts) {
    verdict.suspects = blame_.suspects(window, scorer_.lastSeen(), end);
  }
  handler_(verdict);
}

}  // namespace self_awareness::core
