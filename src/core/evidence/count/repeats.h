#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "self_awareness/core/stream/attributes.h"

namespace self_awareness::core::evidence {

/// For how long the messages of one event type have been the same, byte for byte.
class Repeats {
 public:
  /// Takes in a message of which something is known, at `now` [ns].
  /// @param most that a gap counts [ns]: who pauses repeats nothing meanwhile
  /// @return time since the first one with the same bytes [ns]
  std::int64_t add(std::int64_t now, const Attributes& attributes, std::int64_t most) {
    const bool goes_on = attributes.same && last_ && now >= *last_;
    lasted_ = goes_on ? lasted_ + std::min(now - *last_, most) : 0;
    last_ = now;
    return lasted_;
  }

 private:
  std::optional<std::int64_t> last_;  // when a message was heard [ns]
  std::int64_t lasted_ = 0;           // the same bytes [ns]
};

}  // namespace self_awareness::core::evidence
