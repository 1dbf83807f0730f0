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
    default:
      return Extent::kAll;
  }
}

bool Acceptance::isAbout(const std::string& of_component, const std::string& of_topic) const {
  return matchesPattern(component, of_component) && matchesPattern(topic, of_topic);
}

bool Acceptances::add(const Acceptance& acceptance) {
  remove(acceptance);
  if (list_.size() >= kMost) {
    return false;
  }
  list_.push_back(acceptance);
  return true;
}

bool Acceptances::remove(const Acceptance& like) {
  const auto found = std::find_if(list_.begin(), list_.end(),
                                  [&](const Acceptance& each) { return each.isLike(like); });
  if (found == list_.end()) {
    return false;
  }
  list_.erase(found);
  return true;
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
