#pragma once

#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/event_log_writer.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"

namespace self_awareness::ros1 {

/// Adds a bag to an event log, as a recording of its own: who reads that gets the same events as
/// from the bag, to the nanosecond.
/// @param rules by which messages become events
/// @param graph who published and subscribed to what; empty: not known
/// @throw BagError if the bag cannot be read, or the log not be written
/// @throw std::invalid_argument if a type field does not fit its messages, or has too many values
void addToEventLog(const BagReader& bag, const EncodingRules& rules, const Graph& graph,
                   EventLogWriter& log, const BagReader::Progress& progress = nullptr);

}  // namespace self_awareness::ros1
