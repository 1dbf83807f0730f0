#pragma once

#include <cstdint>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// Looks for steps forward of the clock of a recording (docs/method.md, section 1.2): once or a
/// few times nothing at all came for long, and then all that comes all the time went on as if the
/// time between had not been. After a pause of the robot or of the recorder, it would not. Steps
/// that isClockStep() sees by itself are not among them.
/// @param events of a recording, in its order
/// @return stamp of the first event after each step [ns], in order
std::vector<std::int64_t> findClockSteps(const std::vector<Event>& events);

/// Steps forward of the clock within a recording.
class ClockSteps {
 public:
  /// @param stamps of the first event after each step [ns], in any order
  explicit ClockSteps(std::vector<std::int64_t> stamps = {});

  /// Whether the clock was set forward between two events in a row.
  /// @param previous stamp of the earlier one of the two [ns]
  /// @param current stamp of the one after it [ns]
  bool between(std::int64_t previous, std::int64_t current) const;

 private:
  std::vector<std::int64_t> stamps_;  // in order
};

}  // namespace self_awareness::core
