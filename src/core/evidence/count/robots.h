#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {

/// Which event types came on which robot: a component that only some robots have is missed on none
/// of the others (docs/robots.md). Recordings that do not name their robot are of one more.
class Robots {
 public:
  /// Adds the recordings of a training, or of one half of it.
  void add(const Statistics& training);
  /// A recording of this robot is known.
  void add(const std::string& robot) { has_[robot]; }
  /// An event type came on it.
  void add(const std::string& robot, EventId id);

  /// Whether they are several: else nothing of what follows says anything.
  bool areSeveral() const { return has_.size() > 1; }
  /// Whether an event type never came on a robot, and others are known.
  bool lacks(const std::string& robot, EventId id) const;
  /// On how many robots an event type came.
  std::size_t numberWith(EventId id) const;

 private:
  std::map<std::string, std::vector<bool>> has_;  // by robot and id; as long as needed
};

}  // namespace self_awareness::core::evidence
