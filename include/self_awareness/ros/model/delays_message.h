#pragma once

#include "self_awareness/DelayHistograms.h"
#include "self_awareness/core/paper/delay_statistics.h"

namespace self_awareness::ros1 {

/// Message with the delays from all event types to one, `to`.
self_awareness::DelayHistograms toMessage(const core::paper::DelayStatistics& statistics,
                                          core::EventId to);
/// Adds a message's counts.
/// @throw std::invalid_argument names the contradiction in the message, or with the event types
void addMessage(const self_awareness::DelayHistograms& message,
                core::paper::DelayStatistics& statistics);

}  // namespace self_awareness::ros1
