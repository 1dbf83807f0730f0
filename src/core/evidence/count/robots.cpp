#include "core/evidence/count/robots.h"

#include <algorithm>

namespace self_awareness::core::evidence {

void Robots::add(const Statistics& training) {
  for (const Statistics::Recording& recording : training.recordings()) {
    add(recording.robot);
    for (EventId id = 0; id < recording.events.size(); ++id) {
      if (recording.events[id] > 0) {
        add(recording.robot, id);
      }
    }
  }
}

void Robots::add(const std::string& robot, EventId id) {
  std::vector<bool>& has = has_[robot];
  if (has.size() <= id) {
    has.resize(id + 1);
  }
  has[id] = true;
}

bool Robots::lacks(const std::string& robot, EventId id) const {
  const auto known = has_.find(robot);
  return areSeveral() && known != has_.end() && (id >= known->second.size() || !known->second[id]);
}

std::size_t Robots::numberWith(EventId id) const {
  return static_cast<std::size_t>(std::count_if(has_.begin(), has_.end(), [id](const auto& robot) {
    return id < robot.second.size() && robot.second[id];
  }));
}

}  // namespace self_awareness::core::evidence
