#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "self_awareness/EventLog.h"
#include "self_awareness/EventLogStart.h"
#include "self_awareness/EventType.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"

namespace self_awareness::ros1 {

/// What a log says besides its events.
struct LogSource {
  EncodingRules encoding;
  std::shared_ptr<const Graph> graph;  ///< none: not known
};

/// An event log of one recording in memory, as it will be written.
struct RecordedLog {
  self_awareness::EventLogStart start;
  std::shared_ptr<const Graph> graph;                   ///< none: not known
  std::vector<self_awareness::EventType> types_before;  ///< which the parts take for known
  std::vector<std::shared_ptr<const self_awareness::EventLog>> parts;
};

/// What a part takes in memory [bytes].
std::size_t bytesOf(const self_awareness::EventLog& part);

/// Writes the log whole or not at all.
/// @throw std::exception if it cannot be written
void writeLog(const RecordedLog& recording, const std::string& path);

}  // namespace self_awareness::ros1
