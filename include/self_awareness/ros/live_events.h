#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <topic_tools/shape_shifter.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>

#include "self_awareness/core/event.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"

namespace self_awareness::ros1 {

/// Subscribes to topics of any type and turns every message into an event, stamped with the time
/// of its receipt.
///
/// Threads: setTopics() and renew() belong to one thread, everything else to the one that serves
/// the node handle's callback queue; the two share nothing but roscpp's queue.
class LiveEvents {
 public:
  using Handler = std::function<void(const core::Event&)>;
  /// Called with the source and topic of a publisher that was not heard before.
  using NewPublisherHandler =
      std::function<void(const std::string& source, const std::string& topic)>;

  /// @param node_handle whose callback queue the messages go through
  /// @param queue_size messages a topic may have waiting; more are dropped, the oldest first
  LiveEvents(const ros::NodeHandle& node_handle, std::uint32_t queue_size, Handler handler,
             NewPublisherHandler on_new_publisher);

  /// Subscribes to these topics and to no others. A topic whose type changed is subscribed to
  /// anew: roscpp holds on to the first type that it met.
  void setTopics(const std::set<std::string>& topics, const Graph& graph);

  /// Lets the next setTopics() subscribe anew where the master knows a publisher: after a restart
  /// of the master, roscpp hears of those that came meanwhile in no other way.
  void renew(const Graph& graph);

  /// Encodes from now on with this encoder; all connections count as new ones.
  /// @param knows_own_topic whether the model knows events of this process on a topic
  void setEncoder(std::shared_ptr<const Encoder> encoder,
                  std::function<bool(const std::string& topic)> knows_own_topic);
  /// Forgets connections that are closed.
  void forgetClosedConnections();

  /// Number of publishers that were heard and are connected.
  std::size_t connections() const { return connections_.size(); }

 private:
  using MessageEvent = ros::MessageEvent<topic_tools::ShapeShifter const>;
  struct Subscription {
    ros::Subscriber subscriber;
    std::string datatype;
  };
  struct LiveConnection {
    boost::shared_ptr<ros::M_string> header;   // keeps the key below alive
    std::optional<ConnectionEncoder> encoder;  // none: left out by the rules
  };

  void onMessage(const std::string& topic, const MessageEvent& message);
  LiveConnection connect(const std::string& topic, const MessageEvent& message);
  bool isOwnOutput(const Connection& connection) const;

  ros::NodeHandle node_handle_;
  std::uint32_t queue_size_;
  Handler handler_;
  NewPublisherHandler on_new_publisher_;
  std::map<std::string, Subscription> subscriptions_;  // of setTopics()'s thread
  std::shared_ptr<const Encoder> encoder_;
  std::function<bool(const std::string&)> knows_own_topic_;
  // All messages of a connection share one header object.
  std::unordered_map<const ros::M_string*, LiveConnection> connections_;
  std::set<std::pair<std::string, std::string>> heard_;  // (source, topic)
  std::vector<std::uint8_t> buffer_;
};

}  // namespace self_awareness::ros1
