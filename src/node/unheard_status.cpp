#include "unheard_status.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>
#include <iterator>

#include "ros/text.h"

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

}  // namespace

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

}  // namespace self_awareness
