#pragma once

#include <vector>

#include "self_awareness/EventLog.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::ros1 {

// Events in few bytes, without loss (docs/bags.md). Most of an event's bits are the last digits of
// its time, which follow no rule: so each delay is stored as it is in `delay_bits` bits, and what
// is above these as that many ones and a zero (Rice's code, the shortest for delays that are
// exponential).

/// Packs events whose stamps do not go back into a part (EventLogPacker::kMostEvents).
/// @throw std::invalid_argument if one does
void pack(const std::vector<core::Event>& events, self_awareness::EventLog& part);
/// The events again.
/// @throw std::invalid_argument if the part's bytes are not what pack() makes
std::vector<core::Event> unpack(const self_awareness::EventLog& part);

}  // namespace self_awareness::ros1
