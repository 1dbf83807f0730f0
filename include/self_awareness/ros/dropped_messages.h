#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace self_awareness::ros1 {

/// Counts the messages that roscpp dropped because a subscription's queue was full. It tells them
/// by its slave API only (getBusStats), so this process asks itself.
class DroppedMessages {
 public:
  /// Dropped since the start, on all subscriptions of this process. May block for some
  /// milliseconds; not for the thread that serves the messages.
  std::uint64_t count();

 private:
  std::map<std::pair<std::string, int>, std::int64_t> by_connection_;  // (topic, id)
  std::uint64_t total_ = 0;
};

}  // namespace self_awareness::ros1
