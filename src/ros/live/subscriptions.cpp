#include "self_awareness/ros/live/subscriptions.h"

#include <ros/console.h>

#include "../text.h"
#include "self_awareness/ros/encoding.h"
#include "topic_subscription.h"

namespace self_awareness::ros1 {

Subscriptions::Subscriptions(const ros::NodeHandle& node_handle, Arrivals& arrivals)
    : node_handle_(node_handle), arrivals_(arrivals) {}

Subscriptions::~Subscriptions() = default;

void Subscriptions::setTopics(const std::set<std::string>& topics, const Graph& graph) {
  for (auto subscription = subscriptions_.begin(); subscription != subscriptions_.end();) {
    const auto published = graph.topics.find(subscription->first);
    const std::string datatype = published == graph.topics.end() ? "" : published->second.datatype;
    std::string& expected = subscription->second.datatype;
    if (expected.empty() || expected == "*") {
      expected = datatype;
    }
    const bool type_changed = !datatype.empty() && datatype != "*" && datatype != expected;
    if (type_changed && changed_.add(subscription->first)) {
      ROS_WARN("%s: the type changed from %s to %s; subscribing again",
               subscription->first.c_str(), printable(expected, kLongestName).c_str(),
               printable(datatype, kLongestName).c_str());
    }
    if (type_changed || topics.count(subscription->first) == 0) {
      subscription = subscriptions_.erase(subscription);
    } else {
      ++subscription;
    }
  }
  for (const std::string& topic : topics) {
    if (subscriptions_.count(topic) > 0) {
      continue;
    }
    const auto published = graph.topics.find(topic);
    Subscription& subscription = subscriptions_[topic];
    subscription.datatype = published == graph.topics.end() ? "" : published->second.datatype;
    subscription.subscription =
        std::make_unique<TopicSubscription>(node_handle_, arrivals_, topic);
  }
}

void Subscriptions::adaptReading() {
  for (auto& [topic, subscription] : subscriptions_) {
    subscription.subscription->adaptReading();
  }
}

void Subscriptions::renew(const std::set<std::string>& topics) {
  for (const std::string& topic : topics) {
    subscriptions_.erase(topic);
  }
}

}  // namespace self_awareness::ros1
