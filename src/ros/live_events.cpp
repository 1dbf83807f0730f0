#include "self_awareness/ros/live_events.h"

#include <ros/console.h>
#include <ros/serialization.h>
#include <ros/subscribe_options.h>

#include <boost/bind/bind.hpp>
#include <stdexcept>
#include <utility>

namespace self_awareness::ros1 {

LiveEvents::LiveEvents(const ros::NodeHandle& node_handle, std::uint32_t queue_size,
                       Handler handler, ConnectionHandler on_connection)
    : node_handle_(node_handle),
      queue_size_(queue_size),
      handler_(std::move(handler)),
      on_connection_(std::move(on_connection)) {}

void LiveEvents::setTopics(const std::set<std::string>& topics, const Graph& graph) {
  for (auto subscription = subscriptions_.begin(); subscription != subscriptions_.end();) {
    const auto published = graph.topics.find(subscription->first);
    const std::string datatype = published == graph.topics.end() ? "" : published->second.datatype;
    std::string& expected = subscription->second.datatype;
    if (expected.empty() || expected == "*") {
      expected = datatype;
    }
    const bool type_changed = !datatype.empty() && datatype != "*" && datatype != expected;
    if (type_changed) {
      ROS_WARN("%s: the type changed from %s to %s; subscribing anew", subscription->first.c_str(),
               expected.c_str(), datatype.c_str());
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
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const MessageEvent&>(
        topic, queue_size_,
        [this, topic](const MessageEvent& message) { onMessage(topic, message); });
    options.transport_hints = ros::TransportHints().tcpNoDelay();
    const auto published = graph.topics.find(topic);
    Subscription& subscription = subscriptions_[topic];
    subscription.datatype = published == graph.topics.end() ? "" : published->second.datatype;
    subscription.subscriber = node_handle_.subscribe(options);
  }
}

void LiveEvents::renew(const Graph& graph) {
  for (const auto& [name, topic] : graph.topics) {
    if (!topic.publishers.empty()) {
      subscriptions_.erase(name);
    }
  }
}

void LiveEvents::setEncoder(std::shared_ptr<const Encoder> encoder, OwnOutput own_output) {
  encoder_ = std::move(encoder);
  own_output_ = std::move(own_output);
  for (auto& [key, live] : connections_) {
    live.encoder = connect(connectionFrom(*live.header, live.topic));
    if (live.encoder) {
      live.encoder->accept();  // the first message came before
    }
  }
}

void LiveEvents::forgetClosedConnections() {
  for (auto connection = connections_.begin(); connection != connections_.end();) {
    connection = connection->second.header.use_count() == 1 ? connections_.erase(connection)
                                                            : std::next(connection);
  }
}

void LiveEvents::onMessage(const std::string& topic, const MessageEvent& message) {
  if (!encoder_) {
    return;
  }
  const boost::shared_ptr<ros::M_string>& header = message.getConnectionHeaderPtr();
  auto connection = connections_.find(header.get());
  if (connection == connections_.end()) {
    LiveConnection live{header, topic, connect(connectionFrom(*header, topic))};
    connection = connections_.emplace(header.get(), std::move(live)).first;
    if (connection->second.encoder) {
      on_connection_();
    }
  }
  std::optional<ConnectionEncoder>& encoder = connection->second.encoder;
  if (!encoder || !encoder->accept()) {
    return;
  }
  const auto stamp = static_cast<std::int64_t>(message.getReceiptTime().toNSec());
  if (!encoder->needsContent()) {
    handler_({stamp, encoder->id()});
    return;
  }
  const topic_tools::ShapeShifter& content = *message.getConstMessage();
  buffer_.resize(content.size());
  ros::serialization::OStream stream(buffer_.data(), content.size());
  content.write(stream);
  try {
    handler_({stamp, encoder->id(buffer_.data(), buffer_.size())});
  } catch (const std::out_of_range& error) {
    ROS_ERROR_THROTTLE(10, "%s from %s: %s; the message is left out", topic.c_str(),
                       message.getPublisherName().c_str(), error.what());
  }
}

std::optional<ConnectionEncoder> LiveEvents::connect(const Connection& connection) const {
  if (own_output_.covers(connection.callerid, connection.topic)) {
    return std::nullopt;
  }
  try {
    return encoder_->connect(connection);
  } catch (const std::invalid_argument& error) {
    ROS_ERROR("%s from %s: %s; its messages are left out", connection.topic.c_str(),
              connection.callerid.c_str(), error.what());
    return std::nullopt;
  }
}

}  // namespace self_awareness::ros1
