#pragma once

#include "diagnostic_status.h"
#include "self_awareness/Components.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"

namespace self_awareness::ros1 {

/// How all components are, for programs. Nobody is left out: nodes of the graph that the model
/// does not know are there, with the reason why they are not watched.
/// @param graph who publishes and subscribes to what; null: not known
/// @param encoder gives nodes the names that components have
self_awareness::Components toComponents(const CommunicationState& state, const Graph* graph,
                                        const Encoder& encoder);

}  // namespace self_awareness::ros1
