#pragma once

#include <cstdint>

#include "self_awareness/core/stream/event.h"

namespace self_awareness {

constexpr std::int64_t kSecond = core::kNanosecondsPerSecond;
constexpr std::int64_t kWindow = kSecond / 10;         // [ns]
constexpr std::int64_t kStart = 1600000000 * kSecond;  // when a test begins, since 1970 [ns]

}  // namespace self_awareness
