#pragma once

#include <cstddef>

namespace self_awareness::ros1 {

/// How much of what publishers send is kept in memory, where the content of messages is read. A
/// message that goes beyond is heard, but not read, and counts as dropped.
struct ReadLimits {
  /// Most of one message [bytes].
  std::size_t message = 100000000;
  /// Most of all messages that have not come as a whole [bytes].
  std::size_t together = 400000000;
};

}  // namespace self_awareness::ros1
