#pragma once

#include <cstdint>

#include "self_awareness/core/stream/event.h"

namespace self_awareness {

/// What is heard is cut into stretches, to tell what was normal all the time from what was not.
/// Length of one [ns]; the last one before the end may be shorter.
constexpr std::int64_t kLongestStretch = 1800 * core::kNanosecondsPerSecond;
constexpr std::int64_t kShortestStretch = 10 * core::kNanosecondsPerSecond;

}  // namespace self_awareness
