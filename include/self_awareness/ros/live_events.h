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
#include "self_awareness/ros/own_output.h"

namespace self_awareness::ros1 {

/// Subscribes to topics of any type and turns every message into an event, stamped with the time
/// of its receipt.
///
/// Threads: setTopics() and renew() belong to one thread, everything else to the one that serves
/// the node handle's callback queue; the two share nothing but roscpp's queue.
class LiveEvents {
 public:
  using Handler = std::function<void(const core::Event&)>;
  /// Called with the first message of a connection, before any event, unless the rules leave it
  /// out.
  using ConnectionHandler = std::function<void()>;

  /// @param node_handle whose callback queue the messages go through
  /// @param queue_size messages a topic may have waiting; more are dropped, the oldest first
  LiveEvents(const ros::NodeHandle& node_handle, std::uint32_t queue_size, Handler handler,
             ConnectionHandler on_connection);

  /// Subscribes to these topics and to no others. A topic whose type changed is subscribed to
  /// anew: roscpp holds on to the first type that it met.
  void setTopics(const std::set<std::string>& topics, const Graph& graph);

  /// Lets the next setTopics() subscribe anew where the master knows a publisher: after a restart
  /// of the master, roscpp hears of those that came meanwhile in no other way.
  void renew(const Graph& graph);

  /// Encodes from now on with this encoder. Connections that were heard are no new ones: the next
  /// message on a latching one is an event.
  /// @param own_output left out
  void setEncoder(std::shared_ptr<const Encoder> encoder, OwnOutput own_output);
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
    boost::shared_ptr<ros::M_string> header;  // keeps the key below alive
    std::string topic;
    std::optional<ConnectionEncoder> encoder;  // none: left out by the rules
  };

  void onMessage(const std::string& topic, const MessageEvent& message);
  std::optional<ConnectionEncoder> connect(const Connection& connection) const;

  ros::NodeHandle node_handle_;
  std::uint32_t queue_size_;
  Handler handler_;
  ConnectionHandler on_connection_;
  std::map<std::string, Subscription> subscriptions_;  // of setTopics()'s thread
  std::shared_ptr<const Encoder> encoder_;
  OwnOutput own_output_;
  // All messages of a connection share one header object.
  std::unordered_map<const ros::M_string*, LiveConnection> connections_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace self_awareness::ros1
