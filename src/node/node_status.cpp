#include "node_status.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>
#include <iterator>

#include "core/verdict/name_list.h"
#include "ros/text.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness {
namespace {

// A replay that is started, or looks for its next message, takes less.
constexpr std::int64_t kWarning = 3 * core::kNanosecondsPerSecond;
constexpr std::int64_t kError = 10 * core::kNanosecondsPerSecond;

constexpr std::size_t kMostInMessage = 3;

std::string describe(const ros1::Unheard& unheard) {
  if (unheard.node.empty()) {
    return unheard.why;
  }
  return ros1::printable(unheard.node, ros1::kLongestQuote) + " on " +
         ros1::printable(unheard.topic, ros1::kLongestQuote) + " (" + unheard.why + ")";
}

}  // namespace

bool clockStands(std::int64_t stands_still_for) {
  return stands_still_for >= kWarning;
}

void tellClock(std::int64_t stands_still_for, std::int64_t ros_now,
               diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (clockStands(stands_still_for)) {
    const std::string seconds =
        std::to_string(stands_still_for / core::kNanosecondsPerSecond) + " s";
    status.mergeSummary(
        stands_still_for >= kError ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN,
        ros_now == 0 ? "no /clock for " + seconds + ", though /use_sim_time is set"
                     : "ROS time has stood still for " + seconds + ": is /clock published?");
  }
}

void tellRivals(const std::string& rivals, diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!rivals.empty()) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                        "several nodes publish /clock (" + rivals +
                            "): where ROS time jumps, the steady clock counts");
  }
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
  status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                      "not heard: " + core::listed(words, kMostInMessage));
  ros1::tellNumbered("not heard", words, lists, status);
}

}  // namespace self_awareness
