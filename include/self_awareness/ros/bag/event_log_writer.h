#pragma once

#include <cstdint>
#include <string>

#include "self_awareness/EventLog.h"
#include "self_awareness/EventLogStart.h"
#include "self_awareness/ros/bag/bag_writer.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"

namespace self_awareness::ros1 {

/// Writes an event log: one recording after the other (docs/bags.md). It is a bag with these
/// topics, kVersionTopic, and no others:
constexpr char kEventLogStartTopic[] = "/event_log/start";  ///< EventLogStart
constexpr char kEventLogTopic[] = "/event_log/events";      ///< EventLog
constexpr char kEventLogGraphTopic[] = "/event_log/graph";  ///< EventLogGraph

/// The start of a recording that is heard live, with a fingerprint drawn at random.
/// @param begin when listening began [ns], 0 or more
/// @param robot_start when the robot was started [ns]; 0: not known
/// @param robot its name; empty: not known
self_awareness::EventLogStart startOfRecording(const EncodingRules& encoding, std::int64_t begin,
                                               std::int64_t robot_start = 0,
                                               const std::string& robot = {});

class EventLogWriter {
 public:
  /// Replaces a file that is there.
  /// @param named what errors call the file; empty: by its path
  /// @throw BagError if it cannot be written; so do all functions, and the log is of no use then
  explicit EventLogWriter(const std::string& path, const std::string& named = "")
      : bag_(path, BagWriter::Chunks::kOfOneMessage, named) {}

  /// Begins a recording: what is written from now on belongs to it.
  void start(const self_awareness::EventLogStart& start);
  /// Writes the next part of the recording, numbered.
  void write(self_awareness::EventLog part);
  /// Writes who publishes and subscribes to what, if that has changed in this recording; without
  /// the nodes of this package.
  /// @param stamp ROS time [ns]
  void writeGraph(const Graph& whole, std::int64_t stamp);
  /// Ends the file. Without that, it has no index; `rosbag reindex` makes one.
  void close() { bag_.close(); }

  const std::string& path() const { return bag_.path(); }
  /// Size of the file so far [bytes].
  std::uint64_t size() const { return bag_.size(); }

 private:
  BagWriter bag_;
  bool tells_version_ = false;  // what has been written says it
  std::uint32_t parts_ = 0;     // of this recording
  std::uint64_t events_ = 0;    // of this recording
  Graph graph_;                 // as it was written last
};

}  // namespace self_awareness::ros1
