#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <utility>
#include <vector>

#include "synthetic_system.h"

namespace self_awareness::benchmarks {

/// Memory that operator new has allocated and that is not yet freed [bytes], as malloc rounds it.
std::size_t allocatedBytes();

/// Repeats some events of a system, each round later by the time of one round.
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
  /// Index of the next event in its round.
  std::size_t position() const { return position_; }
  /// Number of events in a round.
  std::size_t size() const { return events_.size(); }

 private:
  static constexpr std::int64_t kBetweenRounds = 1000000;  // [ns]

  std::vector<core::Event> events_;
  std::int64_t round_time_;  // [ns]
  std::int64_t shift_ = 0;   // [ns]
  std::size_t position_ = 0;
};

/// Events of a system with so many event types, other than those for training.
inline EventLoop loopOfEvents(std::size_t types) {
  constexpr std::size_t kEvents = 20000;
  // All timers must have started before the round: else they would be silent in every round for
  // longer than ever in training.
  constexpr std::int64_t kStarting = 3 * core::kNanosecondsPerSecond;
  SyntheticSystem system(types, 2);
  system.take(kStarting);
  std::vector<core::Event> events;
  while (events.size() < kEvents) {
    events.push_back(system.next());
  }
  return EventLoop(std::move(events));
}

/// Statistics of a detector that know all event types of a system, and have counted nothing.
template <typename Statistics, typename... Arguments>
Statistics emptyStatistics(std::size_t types, Arguments... arguments) {
  Statistics statistics(arguments...);
  for (core::EventId id = 0; id < types; ++id) {
    statistics.intern(SyntheticSystem::type(id));
  }
  return statistics;
}

/// Processor time of a training, without the time to make the events.
struct TrainingRun {
  std::size_t events = 0;
  double seconds = 0;
};

/// Trains on the next events of a system; does not keep them.
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
