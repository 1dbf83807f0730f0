#pragma once

#include <optional>
#include <string>
#include <vector>

#include "self_awareness/StandingAlarm.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::ros1 {

/// Writes the whole file or nothing (see OutputFile).
/// @throw FileError or BagError if it cannot be written
void writeStandingAlarm(const self_awareness::StandingAlarm& standing, const std::string& path);

/// @return none: there is no file, or no alarm stood when it was written
/// @throw BagError if it is damaged, or no such file; names it
std::optional<self_awareness::StandingAlarm> readStandingAlarm(const std::string& path);

/// The suspects of a message whose event types are in a vocabulary.
std::vector<core::Suspect> fromMessages(const std::vector<self_awareness::Suspect>& messages,
                                        const core::Vocabulary& vocabulary);

}  // namespace self_awareness::ros1
