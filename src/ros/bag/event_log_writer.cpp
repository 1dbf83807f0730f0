#include "self_awareness/ros/bag/event_log_writer.h"

#include <algorithm>
#include <random>
#include <utility>

#include "self_awareness/EventLogGraph.h"
#include "self_awareness/ros/encoding_message.h"
#include "self_awareness/ros/file_version.h"
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

}  // namespace

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

}  // namespace self_awareness::ros1
