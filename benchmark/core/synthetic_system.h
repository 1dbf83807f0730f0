#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <random>
#include <utility>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::benchmarks {

/// Numbers of event types for which everything is measured.
const std::vector<std::int64_t> kSizes = {15, 60, 150, 300, 1000};

/// A system in which timers of 50 ms to 2 s with jitter start chains of two answers each. The
/// events come one after the other, in the order of their stamps, without end.
class SyntheticSystem {
 public:
  /// @param types number of event types
  /// @param seed of the jitter; the timers and answers are the same for every seed
  explicit SyntheticSystem(std::size_t types, unsigned seed = 1);

  core::Event next();
  /// The next events, of at least this time [ns].
  std::vector<core::Event> take(std::int64_t duration);

  static core::EventType type(core::EventId id);

 private:
  struct Kind {
    std::int64_t period = 0;  // [ns] of a timer; 0: an answer to the event type before it
    std::int64_t delay = 0;   // [ns] of an answer
  };
  using Due = std::pair<std::int64_t, core::EventId>;  // [ns]

  std::int64_t jittered(std::int64_t duration);

  std::mt19937 random_;
  std::vector<Kind> kinds_;  // by id
  std::priority_queue<Due, std::vector<Due>, std::greater<>> due_;
};

}  // namespace self_awareness::benchmarks
