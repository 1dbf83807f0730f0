#include "self_awareness/ros/bag/event_log_writer.h"

#include <algorithm>
#include <random>
#include <utility>

#include "packed_events.h"
#include "self_awareness/EventLogGraph.h"
#include "self_awareness/ros/encoding_message.h"
#include "self_awareness/ros/file_version.h"
#include "self_awareness/ros/output_file.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

// A bag cannot hold a message with the time 0.
ros::Time inBag(const ros::Time& stamp) {
  return std::max(stamp, ros::TIME_MIN);
}

self_awareness::TopicNodes nodesOf(const std::string& name, const Graph::Topic& topic) {
  self_awareness::TopicNodes message;
  message.topic = name;
  message.publishers.assign(topic.publishers.begin(), topic.publishers.end());
  message.subscribers.assign(topic.subscribers.begin(), topic.subscribers.end());
  return message;
}

std::size_t bytesOf(const self_awareness::EventType& type) {
  return sizeof type + type.source.capacity() + type.scope.capacity() + type.type.capacity();
}

}  // namespace

void EventLogPacker::add(const core::Event& event, const core::Vocabulary& vocabulary) {
  // Events that roscpp's threads heard at once may be out of order by microseconds.
  if (events_.size() == kMostEvents || (!events_.empty() && event.stamp < events_.back().stamp)) {
    flush(events_.back().stamp);
  }
  advance(event.stamp);
  if (event.id >= ids_.size()) {
    ids_.resize(event.id + 1);
  }
  std::optional<core::EventId>& id = ids_[event.id];
  if (!id) {
    id = known_++;
    const core::EventType& type = vocabulary.at(event.id);
    self_awareness::EventType message;
    message.source = type.source;
    message.scope = type.scope;
    message.type = type.type;
    new_types_.push_back(message);
  }
  events_.push_back({event.stamp, *id, event.attributes});
}

void EventLogPacker::advance(std::int64_t now) {
  if (!begin_) {
    begin_ = now;
  } else if (now - *begin_ >= kLongestPart) {
    flush(now);
  }
}

void EventLogPacker::flush(std::int64_t now) {
  self_awareness::EventLog part;
  pack(events_, part);
  part.new_types = std::exchange(new_types_, {});
  part.heard_until = toRosTime(std::max(now, events_.empty() ? now : events_.back().stamp));
  part.dropped = dropped_;
  for (const core::Waiting& waiting : waiting_) {
    part.waiting_from.push_back(waiting.from);
    part.waiting_to.push_back(waiting.to);
    part.waited.push_back(waiting.waited);
  }
  waiting_.clear();
  events_.clear();
  begin_ = now;
  handler_(std::move(part));
}

self_awareness::EventLogStart startOfRecording(const EncodingRules& encoding, std::int64_t begin,
                                               std::int64_t robot_start,
                                               const std::string& robot) {
  std::random_device random;
  self_awareness::EventLogStart start;
  start.encoding = toMessage(encoding);
  start.begin = toRosTime(begin);
  start.robot_start = toRosTime(robot_start);
  start.robot = robot;
  start.fingerprint = static_cast<std::uint64_t>(random()) << 32U | random();
  start.has_sources = true;
  return start;
}

void EventLogWriter::start(const self_awareness::EventLogStart& start) {
  parts_ = 0;
  events_ = 0;
  graph_ = {};
  if (!std::exchange(tells_version_, true)) {
    bag_.write({kVersionTopic}, inBag(start.begin), versionOf(kEventLogFile));
  }
  bag_.write({kEventLogStartTopic}, inBag(start.begin), start);
}

void EventLogWriter::write(self_awareness::EventLog part) {
  part.number = parts_++;
  part.events_before = events_;
  events_ += part.events;
  bag_.write({kEventLogTopic}, inBag(part.heard_until), part);
}

void EventLogWriter::writeGraph(const Graph& whole, std::int64_t stamp) {
  const Graph graph = withoutSiblings(whole);
  self_awareness::EventLogGraph message;
  message.stamp = toRosTime(stamp);
  for (const auto& [name, topic] : graph.topics) {
    const auto before = graph_.topics.find(name);
    if (before == graph_.topics.end() || before->second.publishers != topic.publishers ||
        before->second.subscribers != topic.subscribers) {
      message.topics.push_back(nodesOf(name, topic));
    }
  }
  for (const auto& [name, topic] : graph_.topics) {
    if (graph.topics.count(name) == 0) {
      message.topics.push_back(nodesOf(name, {}));
    }
  }
  for (const auto& [node, host] : graph.hosts) {
    const auto before = graph_.hosts.find(node);
    if (before == graph_.hosts.end() || before->second != host) {
      self_awareness::NodeHost& changed = message.hosts.emplace_back();
      changed.node = node;
      changed.host = host;
    }
  }
  if (!message.topics.empty() || !message.hosts.empty()) {
    bag_.write({kEventLogGraphTopic}, inBag(message.stamp), message);
    graph_ = graph;
  }
}

std::size_t bytesOf(const self_awareness::EventLog& part) {
  std::size_t bytes =
      sizeof part + part.packed.capacity() + 3 * sizeof(std::int64_t) * part.waited.capacity();
  for (const self_awareness::EventType& type : part.new_types) {
    bytes += bytesOf(type);
  }
  return bytes;
}

void writeLog(const RecordedLog& recording, const std::string& path) {
  OutputFile file(path);
  EventLogWriter log(file.temporary(), path);
  log.start(recording.start);
  if (recording.graph) {
    log.writeGraph(*recording.graph, static_cast<std::int64_t>(recording.start.begin.toNSec()));
  }
  for (const auto& part : recording.parts) {
    self_awareness::EventLog written = *part;
    if (part == recording.parts.front()) {
      written.new_types.insert(written.new_types.begin(), recording.types_before.begin(),
                               recording.types_before.end());
    }
    log.write(std::move(written));
  }
  log.close();
  file.complete();
}

void addToEventLog(const BagReader& bag, const EncodingRules& rules, const Graph& graph,
                   EventLogWriter& log, const BagReader::Progress& progress) {
  const BagSummary& summary = bag.summary();
  self_awareness::EventLogStart start;
  start.encoding = toMessage(rules);
  start.begin = toRosTime(summary.start);
  start.bag = summary.bag;
  start.fingerprint = summary.fingerprint;
  start.has_sources = summary.has_sources;
  start.one_sender_a_topic = summary.one_sender_a_topic;
  start.copied = summary.copied;
  log.start(start);
  log.writeGraph(graph, summary.start);

  core::Vocabulary vocabulary;
  const Encoder encoder(rules, [&](const core::EventType& type) {
    const std::size_t before = vocabulary.size();
    const core::EventId id = vocabulary.intern(type);
    if (vocabulary.size() > before) {
      checkEventTypes(rules, vocabulary);
    }
    return id;
  });
  EventLogPacker packer([&](self_awareness::EventLog part) { log.write(std::move(part)); });
  bag.read(
      encoder, {}, [&](const core::Event& event) { packer.add(event, vocabulary); }, progress);
  packer.flush(summary.end);
}

}  // namespace self_awareness::ros1
