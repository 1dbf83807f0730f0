#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ros/verdict/status_round.h"
#include "self_awareness/ros/live/subscriptions.h"

namespace self_awareness {

/// Whether simulated time has stood still for so long [ns of steady time] that what was said last
/// may be over.
bool clockStands(std::int64_t stands_still_for);

/// Adds that simulated time stands still, or has not begun: a warning, and an error from 10 s on,
/// since nothing is judged or recorded meanwhile.
/// @param ros_now ROS time [ns]
void tellClock(std::int64_t stands_still_for, std::int64_t ros_now,
               diagnostic_updater::DiagnosticStatusWrapper& status);

/// Adds that several nodes publish /clock: a warning, since ROS time jumps between theirs.
/// @param rivals their names; empty: there are not several
void tellRivals(const std::string& rivals, diagnostic_updater::DiagnosticStatusWrapper& status);

/// Who is not heard, where, and why, in words.
std::vector<std::string> inWords(const std::vector<ros1::Unheard>& unheard);

/// Adds to the status of a node who it does not hear, though the master names them: a warning.
void tellUnheard(const std::vector<ros1::Unheard>& unheard, ros1::ListsAre lists,
                 diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace self_awareness
