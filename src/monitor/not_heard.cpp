#include "not_heard.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>
#include <iterator>

#include "ros/text.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/verdict/name_pattern.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness {
namespace {

constexpr std::size_t kMostInMessage = 3;
constexpr std::size_t kMostOfName = 100;  // bytes

std::string describe(const ros1::Unheard& unheard) {
  if (unheard.node.empty()) {
    return unheard.why;
  }
  return ros1::printable(unheard.node, kMostOfName) + " on " +
         ros1::printable(unheard.topic, kMostOfName) + " (" + unheard.why + ")";
}

std::string notHeard(const std::string& why) {
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

std::vector<std::string> inWords(const std::vector<ros1::Unheard>& unheard) {
  std::vector<std::string> words;
  std::transform(unheard.begin(), unheard.end(), std::back_inserter(words), describe);
  return words;
}

void tellUnheard(const std::vector<ros1::Unheard>& unheard, ros1::ListsAre lists,
                 diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.add("publishers not heard", unheard.size());
  if (unheard.empty()) {
    return;
  }
  const std::vector<std::string> words = inWords(unheard);
  std::string message = "not heard: ";
  for (std::size_t i = 0; i < std::min(words.size(), kMostInMessage); ++i) {
    message += (i > 0 ? ", " : "") + words[i];
  }
  if (words.size() > kMostInMessage) {
    message += " and " + std::to_string(words.size() - kMostInMessage) + " more";
  }
  status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, message);
  ros1::tellNumbered("not heard", words, lists, status);
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
      suspect.reason.words = notHeard(why->second);
    }
  }
}

std::map<std::string, std::string> NotHeard::components() const {
  std::map<std::string, std::string> components;
  for (const auto& [publication, why] : why_) {
    const auto& [source, topic] = publication;
    components.try_emplace(core::componentOf(source, topic), topic + ": " + notHeard(why));
  }
  return components;
}

}  // namespace self_awareness
