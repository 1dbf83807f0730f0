#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/Incident.h"
#include "self_awareness/Incidents.h"
#include "self_awareness/StandingAlarm.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/incident.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::ros1 {

// Files that hold one message each, for another start of the monitor. What writes them writes the
// whole file or nothing (OutputFile), and throws FileError or BagError if that fails. What reads
// them gives none if there is no file, and throws BagError, which names it, if it is damaged or no
// such file.

void writeStandingAlarm(const self_awareness::StandingAlarm& standing, const std::string& path);
/// @return none: also if no alarm stood when it was written
std::optional<self_awareness::StandingAlarm> readStandingAlarm(const std::string& path);
/// The suspects of a message whose event types are in a vocabulary.
std::vector<core::Suspect> fromMessages(const std::vector<self_awareness::Suspect>& messages,
                                        const core::Vocabulary& vocabulary);

/// Incidents that a monitor publishes and keeps, at most so many.
constexpr std::size_t kMostIncidents = 100;

/// What the core knows of an incident; its recording and its model are left empty.
self_awareness::Incident toMessage(const core::Incident& incident);
/// @param message whose level and kind are some, as those of a file that was read
core::Incident fromMessage(const self_awareness::Incident& message);
void writeIncidents(const self_awareness::Incidents& incidents, const std::string& path);
std::optional<self_awareness::Incidents> readIncidents(const std::string& path);

/// The file of what is accepted beside a model (docs/live.md).
std::string pathOfAccepted(const std::string& model);
void writeAccepted(const core::Acceptances& accepted, const std::string& path);
std::optional<core::Acceptances> readAccepted(const std::string& path);

}  // namespace self_awareness::ros1
