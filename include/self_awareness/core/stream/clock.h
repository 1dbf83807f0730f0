#pragma once

#include <cstdint>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// An event whose stamp is at most this much [ns] smaller than that of the event before it is
/// late; the clock was not set (docs/method.md, section 1.2).
constexpr std::int64_t kLatestEvent = kNanosecondsPerSecond / 10;
/// A longer gap than this [ns] between two events is no silence of a robot: the clock was set, or
/// it started to run (messages recorded before the first /clock have the stamp 0).
constexpr std::int64_t kLongestSilence = 3600 * kNanosecondsPerSecond;
/// A smaller step forward [ns] is not told from how much a busy robot's delays vary.
constexpr std::int64_t kSmallestStep = 3 * kNanosecondsPerSecond / 10;

/// Whether a stamp [ns] is of simulated time: that starts at 0, and no robot of ROS ran in 1973.
constexpr bool isSimulated(std::int64_t stamp) {
  return stamp < 100000000 * kNanosecondsPerSecond;
}

/// Whether the clock was set between two events in a row: delays across such a step mean nothing.
/// @param previous stamp of the earlier one of the two [ns]
/// @param current stamp of the one after it [ns]
constexpr bool isClockStep(std::int64_t previous, std::int64_t current) {
  return current < previous - kLatestEvent || current - previous > kLongestSilence;
}

}  // namespace self_awareness::core
