#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// How many events of every type came in the last windows, the sliding count of the rate evidence
/// (docs/method.md, section 1.4).
class RecentCounts {
 public:
  /// @param windows how many windows are counted together, > 0
  RecentCounts(std::size_t types, std::size_t windows);

  /// Counts an event in the open window. @param id less than the number of types
  void add(EventId id) { ++open_[id]; }
  /// Makes room for event types that are new.
  void resize(std::size_t types);
  /// Closes the open window: counts() now holds it.
  void close();
  /// Forgets all windows.
  void restart();

  /// Whether as many windows were closed as are counted together.
  bool full() const { return closed_ >= windows_; }
  /// Events in the last closed windows, by type.
  const std::vector<std::uint32_t>& counts() const { return sums_; }

 private:
  std::size_t types_;
  std::size_t windows_;
  std::size_t closed_ = 0;
  std::vector<std::uint32_t> open_;               // by type
  std::vector<std::vector<std::uint32_t>> ring_;  // of closed windows, each by type
  std::vector<std::uint32_t> sums_;               // over the ring, by type
};

}  // namespace self_awareness::core
