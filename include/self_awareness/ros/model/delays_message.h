#pragma once

#include "self_awareness/DelayHistograms.h"
#include "self_awareness/core/paper/delay_statistics.h"

namespace self_awareness::ros1 {

/// The delays from all event types to one.
self_awareness::DelayHistograms toMessage(const core::paper::DelayStatistics& statistics,
                                          core::EventId to);
/// Adds a message's counts.
/// @throw std::invalid_argument says what in the message contradicts itself or the event types
void addMessage(const self_awareness::DelayHistograms& message,
                core::paper::DelayStatistics& statistics);

}  // namespace self_awareness::ros1
