#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "self_awareness/core/stream/waiting.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {

struct BagIndexEntry;

/// Number of recordings in an event log; none: the file is no event log, or cannot be read.
std::optional<std::size_t> recordingsInEventLog(const std::string& path);

/// An event log whose index was read: once for all recordings in it, of which there may be
/// hundreds.
struct EventLogFile;
/// @throw BagError if the file cannot be read, is no event log, is damaged or too new for this
/// version
std::shared_ptr<const EventLogFile> openEventLog(const std::string& path);

/// What nodes subscribed to in a recording, from when its start had had its time (a minute, at
/// most half of it) to its end. Empty of what was not heard live: the graph beside a bag does not
/// say who left, and who records all topics has others subscribe to what nobody else listens to.
/// @param rules of the encoding
/// @throw std::invalid_argument names a pattern of them that is no regular expression
std::set<core::SourceGraph::Subscription> lastingSubscriptions(const BagSummary& summary,
                                                               const EncodingRules& rules);

/// Reads one recording of an event log as a stream of events, like BagReader.
class EventLogReader {
 public:
  /// @param recording its number in the log, from 0
  /// @throw BagError if the file cannot be read, is no event log, is damaged or too new for this
  /// version, or does not hold this recording
  EventLogReader(const std::string& path, std::size_t recording);
  /// The same of a file whose index was read.
  EventLogReader(std::shared_ptr<const EventLogFile> file, std::size_t recording);

  using WaitingHandler = std::function<void(const core::Waiting&)>;

  const BagSummary& summary() const { return summary_; }
  /// Calls the handler with every event of the range, in the order in which they were heard.
  /// @param rules that the events must have been made by
  /// @param waiting told how the machine was, one stretch of time after the other
  /// @throw BagError if they were made by other rules, the range holds no time of the recording,
  /// or a part is missing or damaged
  void read(const EncodingRules& rules, const EventIds& ids, const TimeRange& range,
            const BagReader::Handler& handler, const BagReader::Progress& progress = nullptr,
            const WaitingHandler& waiting = nullptr) const;

  /// The event types of the recording, also those of which no event is in a part of it.
  /// @throw as read()
  std::set<core::EventType> eventTypes(const EncodingRules& rules) const;

 private:
  /// The rules for what the log calls nodes and topics: those that renamed them already are left
  /// out.
  /// @throw BagError as read()
  EncodingRules rulesOfNames(const EncodingRules& rules) const;

  std::shared_ptr<const EventLogFile> file_;
  std::vector<const BagIndexEntry*> parts_;  // where its events lie, in the order of the recording
  BagSummary summary_;
};

}  // namespace self_awareness::ros1
