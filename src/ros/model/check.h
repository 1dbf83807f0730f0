#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::ros1 {

/// Checks what a message says.
/// @param otherwise in words, where it does not hold; no string is made where it does: some things
/// are checked for every number of a model
/// @throw std::invalid_argument
inline void check(bool holds, const char* otherwise) {
  if (!holds) {
    throw std::invalid_argument(otherwise);
  }
}

/// Whether all are times [ns] from `least` up to ten years: the core multiplies them by small
/// numbers.
inline bool areTimes(const std::vector<std::int64_t>& times, std::int64_t least) {
  constexpr std::int64_t kLongest = std::int64_t{10} * 365 * 86400 * core::kNanosecondsPerSecond;
  return std::all_of(times.begin(), times.end(),
                     [&](std::int64_t time) { return time >= least && time <= kLongest; });
}

}  // namespace self_awareness::ros1
