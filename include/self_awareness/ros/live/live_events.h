#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/attribute_reader.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/live/arrivals.h"
#include "self_awareness/ros/named_once.h"
#include "self_awareness/ros/own_output.h"
#include "self_awareness/ros/sender_watch.h"

namespace self_awareness::ros1 {

/// The bytes of a message.
using Content = std::vector<std::uint8_t>;

/// A node that publishes on a topic.
struct Publication {
  std::string node;  ///< full name, with the number of an anonymous one
  std::string topic;
};

/// Turns messages of any type into events, stamped with the time of their receipt.
///
/// Threads: it belongs to the one that serves the node handle's callback queue. The thread that
/// subscribes (Subscriptions) may be another one: the two share what has arrived, no more.
class LiveEvents {
 public:
  /// Most messages of a publisher that wait to be known for a sibling's: who says more is none.
  static constexpr std::size_t kMostHeld = 100;
  /// Larger messages [bytes] are read once in kBetweenReads [ns of steady time], unless the
  /// encoding needs each: that is enough to see that an image is frozen, or old.
  static constexpr std::uint32_t kLarge = Arrivals::kLarge;
  static constexpr std::int64_t kBetweenReads = 1000000000;

  struct Handlers {
    std::function<void(const core::Event&)> on_event;
    /// The content of a message that is read for its event type, before the event.
    std::function<void(core::EventId, const Content&)> on_content =
        [](core::EventId /*id*/, const Content& /*content*/) {};
    /// The time that an event is stamped with, by ROS time and the steady clock when its message
    /// came [ns].
    std::function<std::int64_t(std::int64_t, std::int64_t)> time =
        [](std::int64_t ros_time, std::int64_t /*steady_time*/) { return ros_time; };
    /// Called by the callback queue when deliver() should not wait any longer: by the first
    /// message after the end of a window, or where a topic's queue fills.
    std::function<void()> on_arrivals;
    /// Messages of this publisher were dropped since the last deliver(), unless the rules leave it
    /// out.
    std::function<void(const Publication&)> on_dropped = [](const auto& /*publication*/) {};
    /// Who sends now, as far as events do not say it, whenever that changes.
    std::function<void(const core::Senders&)> on_senders = [](const auto& /*senders*/) {};
  };

  /// @param node_handle whose callback queue is used
  /// @param queue_size messages a connection may have waiting; what comes then is dropped
  LiveEvents(const ros::NodeHandle& node_handle, std::uint32_t queue_size, Handlers handlers);
  /// Nothing may arrive any more.
  ~LiveEvents();

  /// Where the messages must arrive.
  Arrivals& arrivals() { return arrivals_; }

  /// Encodes from now on with this encoder. Connections that were heard are no new ones: the next
  /// message on a latching one is an event. The mode that was told last, and what is latched, are
  /// told again.
  /// @param own_output left out
  /// @param window length [ns]
  /// @param hold for so long what a publisher says that may be left out once the graph is known
  /// is kept back [ns of steady time]; then it counts as of that moment. 0: nothing is
  void setEncoder(std::shared_ptr<const Encoder> encoder, OwnOutput own_output,
                  std::int64_t window, std::int64_t hold = 0);
  /// Takes in who publishes what now: the other nodes of this package are left out, with what was
  /// kept back of them.
  void setGraph(const Graph& graph);
  /// Turns what has arrived into events. Messages wait for this call.
  void deliver();
  /// Forgets connections that are closed.
  void forgetClosedConnections();

  /// Number of publishers that were heard, are connected, and are not left out.
  std::size_t connections() const;
  /// Number of messages that were dropped since the start.
  std::uint64_t dropped() const { return arrivals_.dropped(); }

 private:
  class Wake;
  struct LiveConnection {
    boost::shared_ptr<ros::M_string> header;  // keeps the key below alive
    std::shared_ptr<const std::string> topic;
    AttributeReader attributes;
    std::optional<ConnectionEncoder> encoder;  // none: left out by the rules
    std::shared_ptr<SenderWatch::Link> link;   // none: nothing is to be learned of it
    std::optional<std::int64_t> read_at{};     // last [ns of steady time]; none: not yet
    // While it may be left out by a graph to come: until when, from its first message on [ns of
    // steady time], and what it said.
    std::optional<std::int64_t> held_until{};
    std::vector<core::Event> held{};
    std::shared_ptr<const Content> mode{};  // the last message that told one; none: it did not
    std::int64_t mode_told = 0;             // then [ns of steady time]
    bool latched = false;                   // what it holds ready was told
  };

  /// Chooses anew what is left out, of connections that were heard.
  void encodeAgain();
  void onArrival(const Arrival& arrival);
  /// Whether the content of a message is wanted.
  static bool isRead(const LiveConnection& live, const Arrival& arrival);
  /// Puts the bytes of a message into content_.
  void read(const Arrival& arrival);
  /// To another encoder: the mode, and what is latched.
  void tellLastingAgain();
  void tellLatched(LiveConnection& live, std::int64_t stamp, std::int64_t steady_time);
  /// @throw std::out_of_range if the message is too short
  void tellMode(LiveConnection& live, std::int64_t stamp, const Content& content,
                std::int64_t steady_time);
  /// The time that events of now are stamped with [ns].
  std::int64_t now() const;
  /// Hands an event on, or keeps it back.
  void tell(LiveConnection& live, const core::Event& event, std::int64_t steady_time);
  /// Keeps an event back, if it is to be.
  bool hold(LiveConnection& live, const core::Event& event, std::int64_t steady_time);
  /// Hands on what was kept back for long enough.
  void release();
  LiveConnection& connectionOf(const Arrival& arrival);
  std::optional<ConnectionEncoder> connect(const Connection& connection);
  std::uint64_t wakeId() const { return reinterpret_cast<std::uintptr_t>(this); }

  ros::NodeHandle node_handle_;
  const Handlers handlers_;
  const boost::shared_ptr<ros::CallbackInterface> wake_;
  Arrivals arrivals_;
  std::shared_ptr<const Encoder> encoder_;
  OwnOutput own_output_;
  std::int64_t hold_ = 0;       // [ns]
  bool holds_ = false;          // some connections have something held
  bool lasting_again_ = false;  // the mode and what is latched, to another encoder
  // All messages of a connection share one header object.
  std::unordered_map<const ros::M_string*, LiveConnection> connections_;
  std::vector<Arrival> delivered_;  // kept for its memory
  Content content_;                 // of the message that was read last; kept for its memory
  SenderWatch senders_;             // by the steady clock
  NamedOnce complained_of_;         // connections
};

}  // namespace self_awareness::ros1
