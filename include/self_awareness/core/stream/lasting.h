#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"

namespace self_awareness::core {

/// What was told once and lasts: the mode of the robot (mode.h), and what is held ready
/// (isLatched()). A recording begins with it.
class Lasting {
 public:
  /// Takes in the next event.
  void add(const Event& event, const Vocabulary& vocabulary) {
    if (vocabulary.tellsMode(event.id)) {
      mode_ = event.id;
    } else if (vocabulary.isLatched(event.id)) {
      latched_.insert(event.id);
    }
  }
  /// All of it, as events of one moment [ns], the mode first.
  std::vector<Event> at(std::int64_t stamp) const {
    std::vector<Event> events;
    if (mode_) {
      events.push_back({stamp, *mode_, {}});
    }
    for (const EventId id : latched_) {
      events.push_back({stamp, id, {}});
    }
    return events;
  }
  /// Nothing lasts any more: ids mean something else, or the robot was started anew.
  void forget() { *this = {}; }

 private:
  std::optional<EventId> mode_;
  std::set<EventId> latched_;
};

}  // namespace self_awareness::core
