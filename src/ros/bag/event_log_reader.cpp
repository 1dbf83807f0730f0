#include "self_awareness/ros/bag/event_log_reader.h"

#include <ros/serialization.h>
#include <rosbag/exceptions.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "bag_index.h"
#include "bag_messages.h"
#include "open_bag.h"
#include "packed_events.h"
#include "self_awareness/EventLog.h"
#include "self_awareness/EventLogGraph.h"
#include "self_awareness/EventLogStart.h"
#include "self_awareness/ros/encoding_message.h"

namespace self_awareness::ros1 {
namespace {

template <typename Message>
bool holds(const Connection& connection) {
  return connection.datatype == ros::message_traits::datatype<Message>();
}

bool isOfEventLog(const Connection& connection) {
  return holds<self_awareness::EventLogStart>(connection) ||
         holds<self_awareness::EventLog>(connection) ||
         holds<self_awareness::EventLogGraph>(connection);
}

template <typename Message>
void checkVersion(const std::string& path, const Connection& connection) {
  if (holds<Message>(connection) && connection.md5sum != ros::message_traits::md5sum<Message>()) {
    throw BagError(path + ": an event log of another version of self_awareness (md5 " +
                   connection.md5sum + ", this one reads " +
                   ros::message_traits::md5sum<Message>() +
                   "); record it again, or convert its bag again");
  }
}

std::int64_t nanoseconds(const ros::Time& time) {
  return static_cast<std::int64_t>(time.toNSec());
}

/// The messages of an event log.
class LogMessages {
 public:
  LogMessages(std::string path, const BagIndex& index)
      : path_(std::move(path)), messages_(BagMessages::open(path_, index)) {}

  template <typename Message>
  Message read(const BagIndexEntry& entry) {
    try {
      messages_->read(entry, content_);
      Message message;
      ros::serialization::IStream stream(content_.data(),
                                         static_cast<std::uint32_t>(content_.size()));
      ros::serialization::deserialize(stream, message);
      return message;
    } catch (const rosbag::BagException& error) {
      fail(error.what());
    } catch (const ros::serialization::StreamOverrunException& error) {
      fail(error.what());
    } catch (const std::bad_alloc&) {
      fail("or there is too little memory");
    } catch (const std::length_error&) {
      fail("a length is wrong");
    }
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw BagError(path_ + ": the event log is damaged (" + problem + ")" + reindexHint(path_));
  }

 private:
  std::string path_;
  std::unique_ptr<BagMessages> messages_;
  std::vector<std::uint8_t> content_;
};

/// In the order in which they were written: the clock may have been set in between.
void sortByPosition(std::vector<BagIndexEntry>& entries) {
  std::sort(entries.begin(), entries.end(), [](const BagIndexEntry& a, const BagIndexEntry& b) {
    return std::tie(a.chunk, a.offset) < std::tie(b.chunk, b.offset);
  });
}

void add(const self_awareness::EventLogGraph& message, Graph& graph) {
  for (const self_awareness::TopicNodes& nodes : message.topics) {
    Graph::Topic& topic = graph.topics[nodes.topic];
    topic.publishers.insert(nodes.publishers.begin(), nodes.publishers.end());
    topic.subscribers.insert(nodes.subscribers.begin(), nodes.subscribers.end());
  }
}

}  // namespace

bool areOfEventLog(const std::vector<Connection>& connections) {
  return !connections.empty() && std::all_of(connections.begin(), connections.end(), isOfEventLog);
}

struct EventLogReader::Parts {
  BagIndex index;
  std::vector<BagIndexEntry> entries;  // of this recording's events
};

std::optional<std::size_t> recordingsInEventLog(const std::string& path) {
  try {
    if (!areOfEventLog(readBagConnections(path))) {
      return std::nullopt;
    }
    const BagIndex index = openBag(path);
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

EventLogReader::EventLogReader(const std::string& path, std::size_t recording) {
  auto parts = std::make_unique<Parts>();
  parts->index = openBag(path);
  if (!areOfEventLog(parts->index.connections)) {
    throw BagError(path + ": no event log; name a bag as it is");
  }
  for (const Connection& connection : parts->index.connections) {
    checkVersion<self_awareness::EventLogStart>(path, connection);
    checkVersion<self_awareness::EventLog>(path, connection);
    checkVersion<self_awareness::EventLogGraph>(path, connection);
  }
  sortByPosition(parts->index.entries);
  LogMessages messages(path, parts->index);
  std::size_t starts = 0;
  for (const BagIndexEntry& entry : parts->index.entries) {
    const Connection& connection = parts->index.connections[entry.connection];
    const bool is_start = holds<self_awareness::EventLogStart>(connection);
    starts += is_start ? 1 : 0;
    if (starts == 0) {
      throw BagError(path +
                     ": the event log has no start: its beginning was cut off; take it as "
                     "it was written");
    }
    if (starts != recording + 1) {
      continue;
    }
    if (is_start) {
      const auto start = messages.read<self_awareness::EventLogStart>(entry);
      try {
        summary_.encoding = fromMessage(start.encoding);
      } catch (const std::invalid_argument& error) {
        messages.fail(error.what());
      }
      summary_.path = path;
      summary_.clock_watched = start.bag.empty();
      summary_.bag = start.bag.empty() ? path.substr(path.rfind('/') + 1) : start.bag;
      summary_.start = nanoseconds(start.begin);
      summary_.end = summary_.start;
      summary_.fingerprint = start.fingerprint;
      summary_.robot_start = nanoseconds(start.robot_start);
      summary_.has_sources = start.has_sources;
      summary_.one_sender_a_topic = start.one_sender_a_topic;
      summary_.copied = start.copied;
    } else if (holds<self_awareness::EventLogGraph>(connection)) {
      add(messages.read<self_awareness::EventLogGraph>(entry), summary_.graph);
    } else {
      parts->entries.push_back(entry);
    }
  }
  if (recording >= starts) {
    throw BagError(path + ": holds " + std::to_string(starts) +
                   " recordings, and none with the "
                   "number " +
                   std::to_string(recording + 1));
  }
  if (!parts->entries.empty()) {
    const auto last = messages.read<self_awareness::EventLog>(parts->entries.back());
    summary_.end = std::max(summary_.start, nanoseconds(last.heard_until));
    summary_.messages = last.events_before + last.events;
    summary_.dropped = last.dropped;
  }
  parts_ = std::move(parts);
}

EventLogReader::~EventLogReader() = default;

void EventLogReader::read(const EncodingRules& rules, const EventIds& ids, const TimeRange& range,
                          const BagReader::Handler& handler,
                          const BagReader::Progress& progress) const {
  if (!(rules == *summary_.encoding)) {
    throw BagError(summary_.path +
                   ": the event log was recorded by another encoding than the one "
                   "that is wanted; use its own, or convert or record it again by the wanted one");
  }
  const auto [from, to] = limitsIn(summary_, range);
  LogMessages messages(summary_.path, parts_->index);
  std::vector<core::EventType> types;
  std::vector<std::optional<core::EventId>> known;  // by id in the log
  std::uint64_t done = 0;
  for (std::size_t number = 0; number < parts_->entries.size(); ++number) {
    if (progress) {
      progress(done, summary_.messages);
    }
    auto part = messages.read<self_awareness::EventLog>(parts_->entries[number]);
    if (part.number != number || part.events_before != done) {
      messages.fail("a part is missing after " + std::to_string(number) + " parts");
    }
    for (const self_awareness::EventType& type : part.new_types) {
      types.push_back({type.source, type.scope, type.type});
    }
    known.resize(types.size());
    PackedEvents packed;
    packed.first = nanoseconds(part.first);
    packed.events = part.events;
    packed.delay_bits = part.delay_bits;
    packed.id_bits = part.id_bits;
    packed.bytes = std::move(part.packed);
    std::vector<core::Event> events;
    try {
      events = packed.unpack();
    } catch (const std::invalid_argument& error) {
      messages.fail(error.what());
    }
    for (const core::Event& event : events) {
      if (event.id >= known.size()) {
        messages.fail("an event of a type that it does not name");
      }
      if (event.stamp < from || event.stamp > to) {
        continue;
      }
      std::optional<core::EventId>& id = known[event.id];
      if (!id) {
        id = ids(types[event.id]);
      }
      handler({event.stamp, *id});
    }
    done += part.events;
  }
  if (progress) {
    progress(done, summary_.messages);
  }
}

}  // namespace self_awareness::ros1
