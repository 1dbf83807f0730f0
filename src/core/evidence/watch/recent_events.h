#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {

/// Remembers the last events of a recording, for what a suspect is described by: channels keep
/// nothing but sums, since every event costs time there (docs/method.md, section 6).
class RecentEvents {
 public:
  /// So many events are remembered, of 16 bytes each: minutes of a small robot, seconds of a large
  /// one.
  static constexpr std::size_t kMost = 1U << 15U;

  struct Remembered {
    std::int64_t stamp = 0;  ///< [ns]
    EventId id = 0;
    bool stalled = false;  ///< it may have waited while the whole robot stood still
  };

  /// @param types number of event types
  explicit RecentEvents(std::size_t types) : events_(kMost), last_(types, 0) {}

  /// @param stalled whether it may have waited while the whole robot stood still
  void add(const Event& event, bool stalled) {
    ++number_;
    std::uint64_t& last = last_[event.id];
    const std::uint64_t before = isRemembered(last) ? number_ - last : 0;
    events_[number_ % kMost] = {event.stamp, event.id,
                                static_cast<std::uint32_t>(before << 1U) | (stalled ? 1U : 0U)};
    last = number_;
  }
  /// Forgets what was seen: a new recording starts, or the clock was set.
  void restart() {
    number_ = 0;
    last_.assign(last_.size(), 0);
  }
  /// The events of two types that are remembered, the oldest first.
  std::vector<Remembered> of(EventId a, EventId b) const;
  /// How many events of a type that are remembered came after the last one of another type.
  std::size_t since(EventId id, EventId other) const;

 private:
  struct Entry {
    std::int64_t stamp = 0;  // [ns]
    EventId id = 0;
    // Above the lowest bit: so many events before came the last one of its type; 0: none. The
    // lowest bit: stalled.
    std::uint32_t before = 0;
  };

  bool isRemembered(std::uint64_t number) const { return number > 0 && number_ - number < kMost; }
  /// Number of the event of the same type before one that is remembered; 0: none is.
  std::uint64_t before(std::uint64_t number) const;

  std::vector<Entry> events_;        // by number, modulo kMost
  std::uint64_t number_ = 0;         // of the last event, from 1; 0: there was none
  std::vector<std::uint64_t> last_;  // number of the last event, by id; 0: there was none
};

}  // namespace self_awareness::core::evidence
