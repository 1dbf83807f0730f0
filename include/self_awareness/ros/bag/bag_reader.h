#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/sender_watch.h"

namespace self_awareness::ros1 {

/// A bag that cannot be used; the message names the file and what to do.
class BagError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A part of a recording, in seconds from its first message.
struct TimeRange {
  std::optional<double> start;  ///< [s]; none: from the beginning
  std::optional<double> end;    ///< [s]; none: to the end

  /// @throw std::invalid_argument if a value is negative, NaN, or the end is not after the start
  void validate() const;
};

/// The clock was set back while a bag was recorded.
struct SetBack {
  std::int64_t stamp = 0;       ///< of the next message, as it is counted [ns]
  std::int64_t by = 0;          ///< [ns], more than 0
  std::int64_t counted_on = 0;  ///< what is added to later stamps, for all steps up to here [ns]
};

/// What is known of a recording without reading its events: of a bag, or in an event log.
struct BagSummary {
  /// A file of a recording.
  struct File {
    std::string path;
    std::int64_t start = 0;  ///< stamp of its first message [ns]
  };

  std::string path;  ///< of several files, as their names are told: `run_0.bag..4`
  /// File name of the bag; of an event log, of the bag that it was made of, if it was.
  std::string bag;
  std::vector<File> files;     ///< of a bag: one or more, in their order
  std::int64_t start = 0;      ///< of the first message, or when listening began [ns]
  std::int64_t end = 0;        ///< of the last message, or when listening ended [ns]
  std::uint64_t messages = 0;  ///< in the bag, whether they are events or not; events of a log
  /// Hash over the time and the topic of every message. It does not depend on compression, or on
  /// the program that wrote the messages again. A log has that of its bag, or a random one.
  std::uint64_t fingerprint = 0;
  bool has_sources = false;  ///< at least one connection names its publisher
  /// rosbag's Python library wrote the bag: it keeps one connection a topic. If several nodes
  /// published there, all messages are under the name of the first.
  bool one_sender_a_topic = false;
  /// It is so of a recording that was copied: by `rosbag filter`, `compress` or `decompress`.
  bool copied = false;
  /// Of bags: why some connections are no events whatever the encoding (whyLeftOut), each reason
  /// once, and no more than kMostReasons.
  std::vector<std::string> left_out;
  /// Of bags, in order: stamps go on as if the clock had not been set back.
  std::vector<SetBack> set_back;
  static constexpr std::size_t kMostReasons = 10;

  // Of event logs only:
  std::optional<EncodingRules> encoding;  ///< by which messages became events
  std::int64_t robot_start = 0;  ///< recordings that share it are of one start [ns]; 0: not known
  std::string robot;             ///< its name; empty: not known
  bool clock_watched = false;  ///< it was heard live: a new recording began when ROS time was set
  Graph graph;                 ///< all who ever published or subscribed
  std::vector<GraphChange> graph_changes;  ///< in their order
  std::uint64_t dropped = 0;               ///< messages that came too fast to be written
};

/// First and last stamp [ns] of a range of a recording.
struct StampRange {
  /// @throw std::invalid_argument if `range` is not valid
  StampRange(const BagSummary& summary, const TimeRange& range);

  bool holds(std::int64_t stamp) const { return first <= stamp && stamp <= last; }

  std::int64_t first;
  std::int64_t last;
};

/// The event types of a recording's bags by their connections, which takes no time: without values
/// of fields, and also those of which no message is in a part of it.
/// @throw BagError as BagReader
std::set<core::EventType> eventTypesIn(const std::vector<std::string>& paths,
                                       const Encoder& encoder);

class RecordingFiles;

/// Reads a bag as a stream of events. Time, topic, type and callerid come from the index, which is
/// read once and kept (24 bytes a message). Messages themselves are read for their attributes.
/// The bags of `rosbag record --split` are read as one.
class BagReader {
 public:
  using Handler = std::function<void(const core::Event&)>;
  /// Called from time to time with the number of messages passed and of all; may throw to stop.
  using Progress = std::function<void(std::uint64_t done, std::uint64_t all)>;

  /// Reads the index, and unpacks compressed chunks to check what is in them.
  /// @param progress called with the number of chunks, not of messages
  /// @throw BagError if the file is missing, no bag, unindexed, truncated, damaged or without
  /// messages
  explicit BagReader(const std::string& path, const Progress& progress = nullptr);
  /// The same of the files of one recording, in their order.
  /// @param paths one or more
  explicit BagReader(const std::vector<std::string>& paths, const Progress& progress = nullptr);
  ~BagReader();

  const BagSummary& summary() const { return summary_; }
  /// Calls the handler with every event of the range, in the order of the recording.
  /// @param senders told who sends, before the event that shows it; none: nobody wants to know
  /// @throw BagError if the range holds no time of the recording or a message cannot be read
  /// @throw std::invalid_argument if a type field, or the field of the mode, does not fit a
  /// message's definition
  void read(const Encoder& encoder, const TimeRange& range, const Handler& handler,
            const Progress& progress = nullptr,
            const SenderWatch::Handler& senders = nullptr) const;
  /// The values of the fields that have classes (EncodingRules::classes), learned or not, of all
  /// messages of the range that are events, by datatype.
  /// @throw as read()
  std::map<std::string, std::vector<double>> readNumbers(const EncodingRules& rules,
                                                         const TimeRange& range) const;

 private:
  /// Calls use() with what reads messages.
  /// @throw BagError for all that may go wrong with them
  template <typename Use>
  void withMessages(const Use& use) const;

  std::unique_ptr<const RecordingFiles> files_;
  BagSummary summary_;
};

}  // namespace self_awareness::ros1
