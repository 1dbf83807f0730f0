#include "self_awareness/core/verdict/acceptance.h"

#include <algorithm>

#include "self_awareness/core/verdict/name_pattern.h"

namespace self_awareness::core {

Acceptance::Extent Acceptance::extent() const {
  switch (kind.value_or(Kind::kDied)) {
    case Kind::kStranger:
      return Extent::kStranger;
    case Kind::kSlow:
    case Kind::kFast:
    case Kind::kLate:
    case Kind::kEarly:
    case Kind::kOutOfOrder:
      return Extent::kTime;
    case Kind::kStale:
    case Kind::kLossy:
    case Kind::kOtherSize:
    case Kind::kStuck:
      return Extent::kMessages;
    case Kind::kUnsubscribed:
      return Extent::kConnections;
    case Kind::kBusyMachine:
    case Kind::kAllSilent:
    case Kind::kNewMode:
      return Extent::kNothing;
    case Kind::kDied:
    case Kind::kNeverCame:
      break;
  }
  return Extent::kAll;
}

bool Acceptance::isAbout(const std::string& of_component, const std::string& of_topic) const {
  return matchesPattern(component, of_component) && matchesPattern(topic, of_topic);
}

bool Acceptances::add(const Acceptance& acceptance) {
  list_.erase(std::remove_if(list_.begin(), list_.end(),
                             [&](const Acceptance& each) { return each.isLike(acceptance); }),
              list_.end());
  if (list_.size() >= kMost) {
    return false;
  }
  list_.push_back(acceptance);
  return true;
}

std::vector<Acceptance> Acceptances::remove(const Acceptance& pattern) {
  const auto removed =
      std::stable_partition(list_.begin(), list_.end(), [&](const Acceptance& each) {
        return !pattern.isAbout(each.component, each.topic) ||
               (pattern.kind && pattern.kind != each.kind);
      });
  std::vector<Acceptance> taken_back(removed, list_.end());
  list_.erase(removed, list_.end());
  return taken_back;
}

bool Acceptances::covers(const std::string& component, const std::string& topic, Kind kind) const {
  Acceptance asked;
  asked.kind = kind;
  return std::any_of(list_.begin(), list_.end(), [&](const Acceptance& each) {
    return each.isAbout(component, topic) &&
           (each.extent() == Acceptance::Extent::kAll || each.extent() == asked.extent());
  });
}

}  // namespace self_awareness::core
