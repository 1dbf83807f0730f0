#include "self_awareness/ros/bag/event_log_reader.h"

#include <ros/serialization.h>
#include <rosbag/exceptions.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "../text.h"
#include "bag_index.h"
#include "open_bag.h"
#include "packed_events.h"
#include "self_awareness/EventLog.h"
#include "self_awareness/EventLogGraph.h"
#include "self_awareness/EventLogStart.h"
#include "self_awareness/core/evidence/tuning.h"
#include "self_awareness/ros/bag/event_log_writer.h"
#include "self_awareness/ros/encoding_message.h"
#include "self_awareness/ros/ros_time.h"
#include "self_awareness/ros/stable_name.h"
#include "stored_messages.h"
#include "version_of_bag.h"

namespace self_awareness::ros1 {
namespace {

/// The messages of an event log.
class LogMessages {
 public:
  LogMessages(std::string path, const BagIndex& index)
      : path_(std::move(path)), messages_(path_, index) {}

  template <typename Message>
  Message read(const BagIndexEntry& entry) {
    try {
      return messages_.read<Message>(entry);
    } catch (const rosbag::BagException& error) {
      fail(error.what());
    } catch (const std::invalid_argument& error) {
      fail(error.what());
    } catch (const std::bad_alloc&) {
      fail("or there is too little memory");
    }
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw BagError(path_ + ": the event log is damaged (" + problem + ")" + reindexHint(path_));
  }

 private:
  std::string path_;
  StoredMessages messages_;
};

/// In the order in which they were written: the clock may have been set in between.
void sortByPosition(std::vector<BagIndexEntry>& entries) {
  std::sort(entries.begin(), entries.end(), [](const BagIndexEntry& a, const BagIndexEntry& b) {
    return std::tie(a.chunk, a.offset) < std::tie(b.chunk, b.offset);
  });
}

void add(const self_awareness::EventLogGraph& message, BagSummary& summary) {
  GraphChange& change = summary.graph_changes.emplace_back();
  change.stamp = fromRosTime(message.stamp);
  for (const self_awareness::TopicNodes& nodes : message.topics) {
    const std::string name = resolvedName(nodes.topic);
    Graph::Topic& topic = summary.graph.topics[name];
    topic.publishers.insert(nodes.publishers.begin(), nodes.publishers.end());
    topic.subscribers.insert(nodes.subscribers.begin(), nodes.subscribers.end());
    change.topics[name] = {"",
                           {nodes.publishers.begin(), nodes.publishers.end()},
                           {nodes.subscribers.begin(), nodes.subscribers.end()}};
  }
  for (const self_awareness::NodeHost& each : message.hosts) {
    summary.graph.hosts[each.node] = each.host;
  }
}

/// An event type of a log by the names of today; none if the rules leave it out.
/// @param encoder for the names that the log has
std::optional<core::EventType> named(const self_awareness::EventType& type,
                                     const Encoder& encoder) {
  core::EventType recorded{type.source, type.scope, type.type};
  const bool same =
      encoder.sourceOf(type.source) == type.source && encoder.scopeOf(type.scope) == type.scope;
  return same ? std::move(recorded) : encoder.renamed(recorded);
}

std::vector<core::Waiting> waitingIn(const self_awareness::EventLog& part,
                                     const LogMessages& messages) {
  if (part.waiting_to.size() != part.waiting_from.size() ||
      part.waited.size() != part.waiting_from.size()) {
    messages.fail("how long processes waited is cut off");
  }
  std::vector<core::Waiting> stretches;
  for (std::size_t k = 0; k < part.waited.size(); ++k) {
    const core::Waiting waiting{part.waiting_from[k], part.waiting_to[k], part.waited[k]};
    if (waiting.from < 0 || waiting.to < waiting.from || waiting.waited < 0 ||
        waiting.waited > waiting.to - waiting.from) {
      messages.fail("processes waited for longer than time passed");
    }
    stretches.push_back(waiting);
  }
  return stretches;
}

}  // namespace

struct EventLogFile {
  std::string path;
  BagIndex index;
  /// By recording: its messages, the start first, in the order in which they were written.
  std::vector<std::vector<BagIndexEntry>> recordings{};
};

std::shared_ptr<const EventLogFile> openEventLog(const std::string& path) {
  auto file = std::make_shared<EventLogFile>(EventLogFile{path, openBag(path)});
  BagIndex& index = file->index;
  if (!isEventLog(path, index)) {
    throw BagError(path + ": no event log; name a bag as it is");
  }
  checkedVersion(path, index, kEventLogFile);
  sortByPosition(index.entries);
  for (const BagIndexEntry& entry : index.entries) {
    const Connection& connection = index.connections[entry.connection];
    if (!isOfEventLog(connection)) {
      continue;
    }
    if (holds<self_awareness::EventLogStart>(connection)) {
      file->recordings.emplace_back();
    }
    if (file->recordings.empty()) {
      throw BagError(path +
                     ": the event log has no start: its beginning was cut off; take it as "
                     "it was written");
    }
    file->recordings.back().push_back(entry);
  }
  return file;
}

std::optional<std::size_t> recordingsInEventLog(const std::string& path) {
  try {
    if (!mayBeEventLog(readBagConnections(path))) {
      return std::nullopt;
    }
    const BagIndex index = openBag(path);
    if (!isEventLog(path, index)) {
      return std::nullopt;
    }
    return static_cast<std::size_t>(
        std::count_if(index.entries.begin(), index.entries.end(), [&](const BagIndexEntry& entry) {
          return holds<self_awareness::EventLogStart>(index.connections[entry.connection]);
        }));
  } catch (const rosbag::BagException&) {
    return std::nullopt;
  } catch (const BagError&) {
    return std::nullopt;
  }
}

EventLogReader::EventLogReader(const std::string& path, std::size_t recording)
    : EventLogReader(openEventLog(path), recording) {}

EventLogReader::EventLogReader(std::shared_ptr<const EventLogFile> file, std::size_t recording)
    : file_(std::move(file)) {
  const std::string& path = file_->path;
  const BagIndex& index = file_->index;
  if (recording >= file_->recordings.size()) {
    throw BagError(path + ": holds " + std::to_string(file_->recordings.size()) +
                   " recordings, and none with the "
                   "number " +
                   std::to_string(recording + 1));
  }
  LogMessages messages(path, index);
  for (const BagIndexEntry& entry : file_->recordings[recording]) {
    const Connection& connection = index.connections[entry.connection];
    if (holds<self_awareness::EventLogStart>(connection)) {
      const auto start = messages.read<self_awareness::EventLogStart>(entry);
      try {
        summary_.encoding = fromMessage(start.encoding);
      } catch (const std::invalid_argument& error) {
        messages.fail(error.what());
      }
      summary_.path = path;
      summary_.clock_watched = start.bag.empty();
      summary_.bag = start.bag.empty() ? printable(path.substr(path.rfind('/') + 1)) : start.bag;
      summary_.start = fromRosTime(start.begin);
      summary_.end = summary_.start;
      summary_.fingerprint = start.fingerprint;
      summary_.robot_start = fromRosTime(start.robot_start);
      summary_.robot = printable(start.robot);
      summary_.has_sources = start.has_sources;
      summary_.one_sender_a_topic = start.one_sender_a_topic;
      summary_.copied = start.copied;
    } else if (holds<self_awareness::EventLogGraph>(connection)) {
      add(messages.read<self_awareness::EventLogGraph>(entry), summary_);
    } else if (holds<self_awareness::EventLog>(connection)) {
      parts_.push_back(&entry);
    }
  }
  if (!parts_.empty()) {
    const auto last = messages.read<self_awareness::EventLog>(*parts_.back());
    summary_.end = std::max(summary_.start, fromRosTime(last.heard_until));
    summary_.messages = last.events_before + last.events;
    summary_.dropped = last.dropped;
  }
}

std::set<core::SourceGraph::Subscription> lastingSubscriptions(const BagSummary& summary,
                                                               const EncodingRules& rules) {
  if (!summary.clock_watched) {
    return {};
  }
  const std::int64_t start_time = core::toNanoseconds(core::evidence::Tuning().start_time);
  const std::int64_t from =
      summary.start + std::min(start_time, (summary.end - summary.start) / 2);
  const Encoder encoder(rules, nullptr);
  std::set<core::SourceGraph::Subscription> lasting;
  bool began = false;
  forEachGraph(summary.graph_changes, [&](std::int64_t stamp, const Graph& graph) {
    const std::set<core::SourceGraph::Subscription> now = subscriptionsIn(graph, encoder);
    if (stamp <= from || !began) {
      lasting = now;
    } else {
      std::set<core::SourceGraph::Subscription> both;
      std::set_intersection(lasting.begin(), lasting.end(), now.begin(), now.end(),
                            std::inserter(both, both.end()));
      lasting = std::move(both);
    }
    began = true;
  });
  return lasting;
}

EncodingRules EventLogReader::rulesOfNames(const EncodingRules& rules) const {
  // What was recorded under the robot's own names, or by the first of the renames, may be renamed
  // now by the others.
  EncodingRules recorded = *summary_.encoding;
  EncodingRules left = rules;
  const std::size_t done = recorded.renames.size();
  if (done <= rules.renames.size() &&
      std::equal(recorded.renames.begin(), recorded.renames.end(), rules.renames.begin())) {
    left.renames.erase(left.renames.begin(),
                       left.renames.begin() + static_cast<std::ptrdiff_t>(done));
    recorded.renames = rules.renames;
    if (recorded.mode) {
      recorded.mode->topic = Encoder(left, nullptr).scopeOf(recorded.mode->topic);
    }
  }
  if (!(rules == recorded)) {
    throw BagError(summary_.path +
                   ": the event log has another encoding than the model, or --encoding; "
                   "use the log's own, or record or convert it again with the other one");
  }
  return left;
}

std::set<core::EventType> EventLogReader::eventTypes(const EncodingRules& rules) const {
  const Encoder encoder(rulesOfNames(rules), nullptr);
  LogMessages messages(summary_.path, file_->index);
  std::set<core::EventType> types;
  for (const BagIndexEntry* entry : parts_) {
    for (const auto& type : messages.read<self_awareness::EventLog>(*entry).new_types) {
      if (std::optional<core::EventType> known = named(type, encoder)) {
        types.insert(std::move(*known));
      }
    }
  }
  return types;
}

void EventLogReader::read(const EncodingRules& rules, const EventIds& ids, const TimeRange& range,
                          const BagReader::Handler& handler, const BagReader::Progress& progress,
                          const WaitingHandler& waiting) const {
  const Encoder encoder(rulesOfNames(rules), ids);
  const StampRange stamps(summary_, range);
  LogMessages messages(summary_.path, file_->index);
  std::vector<std::optional<core::EventType>> types;  // by id in the log; none: left out
  std::vector<std::optional<core::EventId>> known;    // the same
  std::vector<core::EventId> latched;                 // what lasts when the range begins
  std::uint64_t done = 0;
  for (std::size_t number = 0; number < parts_.size(); ++number) {
    if (progress) {
      progress(done, summary_.messages);
    }
    const auto part = messages.read<self_awareness::EventLog>(*parts_[number]);
    if (part.number != number || part.events_before != done) {
      messages.fail("a part is missing after " + std::to_string(number) + " parts");
    }
    for (const self_awareness::EventType& type : part.new_types) {
      types.push_back(named(type, encoder));
    }
    known.resize(types.size());
    if (part.events > EventLogPacker::kMostEvents) {
      messages.fail("a part of too many events");
    }
    if (waiting) {
      for (const core::Waiting& each : waitingIn(part, messages)) {
        if (stamps.holds(each.from) && stamps.holds(each.to)) {
          waiting(each);
        }
      }
    }
    std::vector<core::Event> events;
    try {
      events = unpack(part);
    } catch (const std::invalid_argument& error) {
      messages.fail(error.what());
    }
    if (!events.empty() && events.back().stamp > fromRosTime(part.heard_until)) {
      messages.fail("an event after the end of its part");
    }
    for (const core::Event& event : events) {
      if (event.id >= known.size()) {
        messages.fail("an event of a type that it does not name");
      }
      const bool is_held = stamps.holds(event.stamp);
      if (!types[event.id] || event.stamp > stamps.last ||
          (!is_held && !core::isLatched(*types[event.id]))) {
        continue;
      }
      std::optional<core::EventId>& id = known[event.id];
      if (!id) {
        id = ids(*types[event.id]);
      }
      if (!is_held) {
        latched.push_back(*id);
        continue;
      }
      for (const core::EventId held : std::exchange(latched, {})) {
        handler({event.stamp, held, {}});
      }
      handler({event.stamp, *id, event.attributes});
    }
    done += part.events;
  }
  if (progress) {
    progress(done, summary_.messages);
  }
}

}  // namespace self_awareness::ros1
