#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/EventLog.h"
#include "self_awareness/EventLogStart.h"
#include "self_awareness/EventType.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/stream/waiting.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/bag_writer.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"

namespace self_awareness::ros1 {

/// Packs the events of one recording into the parts of an event log (docs/bags.md).
class EventLogPacker {
 public:
  /// A part is handed out when it lasts this long [ns]: what is lost in a crash is no more.
  static constexpr std::int64_t kLongestPart = 20 * core::kNanosecondsPerSecond;
  static constexpr std::size_t kMostEvents = 1U << 15U;  ///< of a part

  using Handler = std::function<void(self_awareness::EventLog)>;

  /// @param handler called with each part in turn, but without its number and events_before
  explicit EventLogPacker(Handler handler) : handler_(std::move(handler)) {}

  /// Takes in the next event, at 0 ns or later.
  /// @param vocabulary that its id is of; it may grow, but ids keep their meaning
  void add(const core::Event& event, const core::Vocabulary& vocabulary);
  /// Takes in how the machine was in the stretch of time after the one before.
  void add(const core::Waiting& waiting) { waiting_.push_back(waiting); }
  /// Says how many messages were dropped since listening began.
  void setDropped(std::uint64_t messages) { dropped_ = messages; }
  /// Says that nothing else was heard before `now` [ns]; hands out the open part if it has lasted
  /// long enough.
  void advance(std::int64_t now);
  /// Hands out the open part, even if it holds no event.
  /// @param now [ns] up to which all was heard
  void flush(std::int64_t now);

 private:
  Handler handler_;
  std::vector<std::optional<core::EventId>> ids_;  // in the log, by id of the vocabulary
  core::EventId known_ = 0;                        // event types in the log
  std::vector<core::Event> events_;                // of the open part, by ids of the log
  std::vector<self_awareness::EventType> new_types_;
  std::optional<std::int64_t> begin_;   // of the open part [ns]
  std::vector<core::Waiting> waiting_;  // of the open part
  std::uint64_t dropped_ = 0;
};

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

/// Adds a bag to an event log, as a recording of its own: who reads that gets the same events as
/// from the bag, to the nanosecond.
/// @param rules by which messages become events
/// @param graph who published and subscribed to what; empty: not known
/// @throw BagError if the bag cannot be read, or the log not be written
/// @throw std::invalid_argument if a type field does not fit its messages, or has too many values
void addToEventLog(const BagReader& bag, const EncodingRules& rules, const Graph& graph,
                   EventLogWriter& log, const BagReader::Progress& progress = nullptr);

}  // namespace self_awareness::ros1
