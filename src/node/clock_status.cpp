#include "clock_status.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <string>

#include "self_awareness/core/stream/event.h"

namespace self_awareness {
namespace {

// A replay that is started, or looks for its next message, takes less.
constexpr std::int64_t kWarning = 3 * core::kNanosecondsPerSecond;
constexpr std::int64_t kError = 10 * core::kNanosecondsPerSecond;

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

}  // namespace self_awareness
