#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <string>
#include <vector>

#include "ros/verdict/status_lists.h"
#include "self_awareness/ros/live/subscriptions.h"

namespace self_awareness {

/// Who is not heard, where, and why, in words.
std::vector<std::string> inWords(const std::vector<ros1::Unheard>& unheard);

/// Adds to the status of a node who it does not hear, though the master names them: a warning.
void tellUnheard(const std::vector<ros1::Unheard>& unheard, ros1::ListsAre lists,
                 diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace self_awareness
