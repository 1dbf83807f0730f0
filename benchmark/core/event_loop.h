#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <utility>
#include <vector>

#include "synthetic_system.h"

namespace self_awareness::benchmarks {

/// Some events of a system over and over, each round later by the time of one round.
class EventLoop {
 public:
  explicit EventLoop(std::vector<core::Event> events)
      : events_(std::move(events)),
        round_time_(events_.back().stamp - events_.front().stamp + kBetweenRounds) {}

  core::Event next() {
    const core::Event event = {events_[position_].stamp + shift_, events_[position_].id};
    if (++position_ == events_.size()) {
      position_ = 0;
      shift_ += round_time_;
    }
    return event;
  }
  /// Index in a round of the event that comes next.
  std::size_t position() const { return position_; }
  /// Events in a round.
  std::size_t size() const { return events_.size(); }

 private:
  static constexpr std::int64_t kBetweenRounds = 1000000;  // [ns]

  std::vector<core::Event> events_;
  std::int64_t round_time_;  // [ns]
  std::int64_t shift_ = 0;   // [ns]
  std::size_t position_ = 0;
};

/// Events of a system of a number of types, not those that it is trained on.
inline EventLoop loopOfEvents(std::size_t types) {
  constexpr std::size_t kEvents = 20000;
  // A round that began before all timers have started would have them silent for longer than they
  // ever were in training, again and again.
  constexpr std::int64_t kStarting = 3 * core::kNanosecondsPerSecond;
  SyntheticSystem system(types, 2);
  system.take(kStarting);
  std::vector<core::Event> events;
  while (events.size() < kEvents) {
    events.push_back(system.next());
  }
  return EventLoop(std::move(events));
}

/// How much processor time training took, without the making of the events.
struct TrainingRun {
  std::size_t events = 0;
  double seconds = 0;
};

/// Trains on the next events of a system, which are not kept.
/// @param duration of the events [ns]
template <typename Trainer>
TrainingRun trainFor(std::int64_t duration, SyntheticSystem& system, Trainer& trainer) {
  TrainingRun run;
  while (duration > 0) {
    const std::int64_t block = std::min(duration, core::kNanosecondsPerSecond);
    const std::vector<core::Event> events = system.take(block);
    const std::clock_t start = std::clock();
    for (const core::Event& event : events) {
      trainer.add(event);
    }
    run.seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    run.events += events.size();
    duration -= block;
  }
  return run;
}

}  // namespace self_awareness::benchmarks
