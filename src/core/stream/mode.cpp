#include "self_awareness/core/stream/mode.h"

#include <algorithm>

namespace self_awareness::core {

void ModeTime::enter(std::optional<EventId> mode, std::int64_t stamp) {
  if (mode_ && mode != mode_) {
    of_[*mode_].before = lasted(*mode_, stamp);
  }
  if (mode != mode_ || !since_) {
    mode_ = mode;
    since_ = stamp;
  }
}

void ModeTime::begin(std::int64_t stamp) {
  since_ = since_.value_or(stamp);
}

void ModeTime::restart() {
  since_.reset();
  of_.clear();
}

std::optional<LastingMode> ModeTime::lasting(std::int64_t now) const {
  if (!mode_) {
    return std::nullopt;
  }
  // A late event does not turn time back.
  return LastingMode{*mode_, since_ ? std::max<std::int64_t>(now - *since_, 0) : 0};
}

std::int64_t ModeTime::lasted(EventId mode, std::int64_t now) const {
  const auto known = of_.find(mode);
  const std::int64_t before = known == of_.end() ? 0 : known->second.before;
  return before + (mode == mode_ ? lasting(now)->lasted : 0);
}

std::optional<Event> ModeTime::tickUntil(std::int64_t now) {
  if (!mode_ || !since_) {
    return std::nullopt;
  }
  Of& of = of_[*mode_];
  const std::int64_t due = *since_ + of.ticks * kTick - of.before;
  if (due > now) {
    return std::nullopt;
  }
  ++of.ticks;
  return Event{due, *mode_};
}

}  // namespace self_awareness::core
