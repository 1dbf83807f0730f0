#pragma once

#include <cstdint>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// How far a stamp may lie behind the one before it and still be a late event [ns].
constexpr std::int64_t kLatestEvent = kNanosecondsPerSecond / 10;
/// A longer gap than this between two events [ns] is no silence of a robot: the clock was set, or
/// started to run (messages recorded before the first /clock have the stamp 0).
constexpr std::int64_t kLongestSilence = 3600 * kNanosecondsPerSecond;

/// Whether the clock was set between two events that follow each other: delays across such a step
/// mean nothing.
constexpr bool isClockStep(std::int64_t previous, std::int64_t current) {
  return current < previous - kLatestEvent || current - previous > kLongestSilence;
}

}  // namespace self_awareness::core
