#pragma once

#include <string>

#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"

namespace self_awareness::ros1 {

/// Why nothing of a robot is heard, in words.
/// @param graph who publishes and who subscribes
/// @param used_only whether only what a node of the robot subscribes to is listened to
std::string whyNothingIsHeard(const Graph& graph, const Encoder& encoder, bool used_only);

}  // namespace self_awareness::ros1
