#include "self_awareness/ros/bag/event_log_writer.h"

#include <algorithm>
#include <utility>

#include "self_awareness/EventLogGraph.h"

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

void EventLogWriter::start(const self_awareness::EventLogStart& start) {
  parts_ = 0;
  events_ = 0;
  graph_ = {};
  bag_.write(kEventLogStartTopic, inBag(start.begin), start);
}

void EventLogWriter::write(self_awareness::EventLog part) {
  part.number = parts_++;
  part.events_before = events_;
  events_ += part.events;
  bag_.write(kEventLogTopic, inBag(part.heard_until), part);
}

void EventLogWriter::writeGraph(const Graph& graph, std::int64_t stamp) {
  self_awareness::EventLogGraph message;
  message.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
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
  if (!message.topics.empty()) {
    bag_.write(kEventLogGraphTopic, inBag(message.stamp), message);
    graph_ = graph;
  }
}

}  // namespace self_awareness::ros1
