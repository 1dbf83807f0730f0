#pragma once

#include "self_awareness/PackedPairs.h"
#include "self_awareness/core/evidence/count/statistics.h"

namespace self_awareness::ros1 {

/// Message with the counts of an event type and its partners.
self_awareness::PackedPairs packedPairs(const core::evidence::Statistics& statistics,
                                        core::EventId id);
/// Gives an event type what a message says of it and its partners.
/// @throw std::invalid_argument names the contradiction in the message, or with the event types
void setPairs(const self_awareness::PackedPairs& message, core::evidence::Statistics& statistics);

}  // namespace self_awareness::ros1
