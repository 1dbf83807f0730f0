#include "not_heard.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>

#include "ros/text.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/verdict/name_pattern.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness {
namespace {

constexpr std::size_t kMostNamed = 20;
constexpr std::size_t kMostInMessage = 3;

std::string describe(const ros1::Unheard& unheard) {
  if (unheard.node.empty()) {
    return unheard.why;
  }
  return ros1::printable(unheard.node, ros1::kLongestName) + " on " +
         ros1::printable(unheard.topic, ros1::kLongestName) + " (" + unheard.why + ")";
}

std::string inWords(const std::string& why) {
  return "not heard by the monitor: " + why;
}

}  // namespace

std::vector<ros1::Unheard> withoutOptional(std::vector<ros1::Unheard> unheard,
                                           const std::vector<std::string>& optional,
                                           const ros1::Encoder& encoder) {
  const auto may_be_absent = [&](const ros1::Unheard& each) {
    return core::isOneOf(optional, encoder.sourceOf(each.node), encoder.scopeOf(each.topic));
  };
  unheard.erase(std::remove_if(unheard.begin(), unheard.end(), may_be_absent), unheard.end());
  return unheard;
}

void tellUnheard(const std::vector<ros1::Unheard>& unheard,
                 diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.add("publishers not heard", unheard.size());
  if (unheard.empty()) {
    return;
  }
  std::string message = "not heard: ";
  for (std::size_t i = 0; i < std::min(unheard.size(), kMostInMessage); ++i) {
    message += (i > 0 ? ", " : "") + describe(unheard[i]);
  }
  if (unheard.size() > kMostInMessage) {
    message += " and " + std::to_string(unheard.size() - kMostInMessage) + " more";
  }
  status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, message);
  for (std::size_t i = 0; i < std::min(unheard.size(), kMostNamed); ++i) {
    status.add("not heard " + std::to_string(i + 1), describe(unheard[i]));
  }
}

void tellStrangers(std::size_t closed, std::size_t newly,
                   diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (newly > 0) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                        std::to_string(newly) +
                            " connections to this node were closed: nothing sensible was said");
  }
  status.add("connections of strangers closed", closed);
}

void NotHeard::set(const std::vector<ros1::Unheard>& unheard, const ros1::Encoder& encoder) {
  why_.clear();
  for (const ros1::Unheard& each : unheard) {
    if (!each.dead && !each.node.empty()) {
      why_[{encoder.sourceOf(each.node), encoder.scopeOf(each.topic)}] = each.why;
    }
  }
}

void NotHeard::explain(std::vector<core::Suspect>& suspects,
                       const core::Vocabulary& vocabulary) const {
  for (core::Suspect& suspect : suspects) {
    const core::EventType& type = vocabulary.at(suspect.id);
    const auto why = why_.find({type.source, type.scope});
    if (why != why_.end() && core::isMissing(suspect.reason.kind)) {
      suspect.reason.words = inWords(why->second);
    }
  }
}

std::map<std::string, std::string> NotHeard::components() const {
  std::map<std::string, std::string> components;
  for (const auto& [publication, why] : why_) {
    const auto& [source, topic] = publication;
    components.try_emplace(core::componentOf(source, topic), topic + ": " + inWords(why));
  }
  return components;
}

}  // namespace self_awareness
