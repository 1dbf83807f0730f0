#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// Counts the events of every type in the last windows, for the rate evidence (docs/method.md,
/// section 1.4).
class RecentCounts {
 public:
  /// @param windows number of windows that are counted together, > 0
  explicit RecentCounts(std::size_t windows);

  /// Counts an event in the open window.
  /// @param id less than the number of types
  void add(EventId id) { ++open_[id]; }
  /// Makes room for new event types.
  /// @param types number of event types from now on
  void resize(std::size_t types);
  /// Closes the open window: counts() then includes it.
  void close();
  /// Forgets all windows.
  void restart();

  /// Whether enough windows were closed for counts() to be valid.
  bool full() const { return closed_ >= ring_.size(); }
  /// Events in the last closed windows, by type.
  const std::vector<std::uint32_t>& counts() const { return sums_; }

 private:
  std::size_t closed_ = 0;
  std::vector<std::uint32_t> open_;               // by type
  std::vector<std::vector<std::uint32_t>> ring_;  // of closed windows, each by type
  std::vector<std::uint32_t> sums_;               // over the ring, by type
};

}  // namespace self_awareness::core
