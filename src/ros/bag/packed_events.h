#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::ros1 {

/// Events in few bytes, without loss (docs/bags.md). Most of an event's bits are the last
/// digits of its time, which follow no rule: so each delay is stored as it is in `delay_bits`
/// bits, and what is above these as that many ones and a zero (Rice's code, the shortest for
/// delays that are exponential).
struct PackedEvents {
  std::int64_t first = 0;       ///< stamp of the first event [ns]
  std::uint32_t events = 0;     ///< number
  std::uint8_t delay_bits = 0;  ///< 0 to 62
  std::uint8_t id_bits = 0;     ///< 0 to 32
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> attributes;  ///< of the messages; empty: nothing is known of any

  /// Packs events whose stamps do not go back.
  /// @throw std::invalid_argument if one does, or there are more than 2^32 - 1 events
  static PackedEvents pack(const std::vector<core::Event>& events);
  /// The events again.
  /// @throw std::invalid_argument if the bytes are not what pack() makes
  std::vector<core::Event> unpack() const;
};

}  // namespace self_awareness::ros1
