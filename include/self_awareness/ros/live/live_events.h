#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/live/arrivals.h"
#include "self_awareness/ros/live/own_output.h"

namespace self_awareness::ros1 {

/// Subscribes to topics of any type and turns every message into an event, stamped with the time
/// of its receipt.
///
/// Threads: setTopics() and renew() belong to one thread, everything else to the one that serves
/// the node handle's callback queue; the two share nothing but what has arrived.
class LiveEvents {
 public:
  struct Handlers {
    std::function<void(const core::Event&)> on_event;
    /// Called with the first message of a connection, before its event, unless the rules leave it
    /// out.
    std::function<void()> on_connection;
    /// Called by the callback queue when deliver() should not wait any longer: by the first
    /// message after the end of a window, or where a topic's queue fills.
    std::function<void()> on_arrivals;
  };

  /// @param node_handle whose callback queue is used
  /// @param queue_size messages a topic may have waiting; what comes then is dropped
  LiveEvents(const ros::NodeHandle& node_handle, std::uint32_t queue_size, Handlers handlers);
  ~LiveEvents();
  LiveEvents(const LiveEvents&) = delete;
  LiveEvents& operator=(const LiveEvents&) = delete;

  /// Subscribes to these topics and to no others. A topic whose type changed is subscribed to
  /// anew: roscpp holds on to the first type that it met.
  void setTopics(const std::set<std::string>& topics, const Graph& graph);

  /// Lets the next setTopics() subscribe anew where the master knows a publisher: after a restart
  /// of the master, roscpp hears of those that came meanwhile in no other way.
  void renew(const Graph& graph);

  /// Encodes from now on with this encoder. Connections that were heard are no new ones: the next
  /// message on a latching one is an event.
  /// @param own_output left out
  /// @param window length [ns]
  void setEncoder(std::shared_ptr<const Encoder> encoder, OwnOutput own_output,
                  std::int64_t window);
  /// Turns what has arrived into events. It waits for this call, however long.
  void deliver();
  /// Forgets connections that are closed.
  void forgetClosedConnections();

  /// Number of publishers that were heard, are connected, and are not left out.
  std::size_t connections() const;
  /// Number of messages that were dropped since the start.
  std::uint64_t dropped() const { return arrivals_.dropped() + unread_; }

 private:
  class Wake;
  struct Subscription {
    ros::Subscriber subscriber;
    std::string datatype;
  };
  struct LiveConnection {
    boost::shared_ptr<ros::M_string> header;  // keeps the key below alive
    std::shared_ptr<Arrival::Topic> topic;
    std::optional<ConnectionEncoder> encoder;  // none: left out by the rules
  };

  void onArrival(const Arrival& arrival);
  LiveConnection& connectionOf(const Arrival& arrival);
  /// Has messages of the topic read if any of its connections needs that.
  void chooseReading(Arrival::Topic& topic) const;
  std::optional<ConnectionEncoder> connect(const Connection& connection) const;
  std::uint64_t wakeId() const { return reinterpret_cast<std::uintptr_t>(this); }

  ros::NodeHandle node_handle_;
  const Handlers handlers_;
  const boost::shared_ptr<ros::CallbackInterface> wake_;
  Arrivals arrivals_;
  std::map<std::string, Subscription> subscriptions_;  // of setTopics()'s thread
  std::shared_ptr<const Encoder> encoder_;
  OwnOutput own_output_;
  // All messages of a connection share one header object.
  std::unordered_map<const ros::M_string*, LiveConnection> connections_;
  std::vector<Arrival> delivered_;  // kept for its memory
  std::uint64_t unread_ = 0;        // messages that would have had to be read
};

}  // namespace self_awareness::ros1
