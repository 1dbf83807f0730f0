#pragma once

#include <cstdint>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::ros1 {

/// Events in few bytes, without loss (docs/event_log.md): by columns, packed by zlib. Most of what
/// is left are the last digits of times, which follow no rule.
struct PackedEvents {
  std::uint32_t events = 0;  ///< number
  std::vector<std::uint8_t> bytes;

  /// Packs events whose stamps do not go back.
  /// @throw std::invalid_argument if one does, or there are more than 2^32 - 1 events
  static PackedEvents pack(const std::vector<core::Event>& events);
  /// The events again. Takes memory by their number, whatever the bytes are.
  /// @throw std::invalid_argument if the bytes are not what pack() makes
  std::vector<core::Event> unpack() const;
};

}  // namespace self_awareness::ros1
