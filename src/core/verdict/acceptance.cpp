#include "self_awareness/core/verdict/acceptance.h"

#include <algorithm>

namespace self_awareness::core {
namespace {

/// Whether something that is accepted is what somebody asks for.
bool fits(const Acceptance& accepted, const Acceptance& pattern) {
  if (pattern.kind && pattern.kind != accepted.kind) {
    return false;
  }
  if (!pattern.together.empty()) {
    return pattern.together == accepted.together;
  }
  if (accepted.together.empty()) {
    return matchesPattern(pattern.component, accepted.component) &&
           matchesPattern(pattern.topic, accepted.topic);
  }
  return pattern.topic.empty() && std::any_of(accepted.together.begin(), accepted.together.end(),
                                              [&](const std::string& each) {
                                                return matchesPattern(pattern.component, each);
                                              });
}

}  // namespace

Acceptance::Extent Acceptance::extent() const {
  switch (kind.value_or(Kind::kSilent)) {
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
    case Kind::kTwoSenders:
    case Kind::kSlowerClock:
      return Extent::kNothing;
    case Kind::kNewMode:
      return Extent::kMode;
    case Kind::kNeverCame:
      return Extent::kAbsence;
    case Kind::kSilent:
    case Kind::kTopicSilent:
    case Kind::kUnanswered:
      break;
  }
  return Extent::kAll;
}

bool Acceptance::isAbout(const std::string& of_component, const std::string& of_topic) const {
  return extent() == Extent::kMode
             ? std::binary_search(together.begin(), together.end(), of_component)
             : matchesPattern(component, of_component) && matchesPattern(topic, of_topic);
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

void Acceptances::add(const Acceptances& others) {
  list_.insert(list_.end(), others.list_.begin(), others.list_.end());
}

std::vector<Acceptance> Acceptances::remove(const Acceptance& pattern) {
  const auto removed = std::stable_partition(
      list_.begin(), list_.end(), [&](const Acceptance& each) { return !fits(each, pattern); });
  std::vector<Acceptance> taken_back(removed, list_.end());
  list_.erase(removed, list_.end());
  return taken_back;
}

bool Acceptances::covers(const std::string& component, const std::string& topic, Kind kind) const {
  const Acceptance::Extent asked = Acceptance{"", "", kind}.extent();
  return std::any_of(list_.begin(), list_.end(), [&](const Acceptance& each) {
    return each.isAbout(component, topic) &&
           (each.extent() == Acceptance::Extent::kAll || each.extent() == asked);
  });
}

bool Acceptances::mayBeAbsent(const std::string& component, const std::string& topic) const {
  return std::any_of(list_.begin(), list_.end(), [&](const Acceptance& each) {
    return each.extent() == Acceptance::Extent::kAbsence && each.isAbout(component, topic);
  });
}

bool Acceptances::coversMode(const std::vector<std::string>& off) const {
  return std::any_of(list_.begin(), list_.end(), [&](const Acceptance& each) {
    return each.extent() == Acceptance::Extent::kMode &&
           std::includes(each.together.begin(), each.together.end(), off.begin(), off.end());
  });
}

}  // namespace self_awareness::core
