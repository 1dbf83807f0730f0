#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "self_awareness/Incident.h"
#include "self_awareness/Incidents.h"
#include "self_awareness/core/verdict/incident.h"

namespace self_awareness::ros1 {

/// Incidents that a monitor publishes and keeps, at most so many.
constexpr std::size_t kMostIncidents = 100;

/// What the core knows of an incident; its recording and its model are left empty.
self_awareness::Incident toMessage(const core::Incident& incident);
/// @param message whose level and kind are some, as those of a file that was read
core::Incident fromMessage(const self_awareness::Incident& message);

/// Writes the whole file or nothing (see OutputFile).
/// @throw FileError or BagError if it cannot be written
void writeIncidents(const self_awareness::Incidents& incidents, const std::string& path);

/// @return none: there is no file
/// @throw BagError if it is damaged, or no such file; names it
std::optional<self_awareness::Incidents> readIncidents(const std::string& path);

}  // namespace self_awareness::ros1
