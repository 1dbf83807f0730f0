#pragma once

#include <cstdint>
#include <string>

#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"

namespace self_awareness {

/// Nothing heard since the start for longer is told [ns of steady time].
constexpr std::int64_t kNothingHeard = 10 * core::kNanosecondsPerSecond;

/// Why nothing is heard, in words.
/// @param graph who publishes what; null: the master has not said it
std::string whyNothingIsHeard(const ros1::Graph* graph, const ros1::Encoder& encoder);

}  // namespace self_awareness
