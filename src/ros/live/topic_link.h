#pragma once

#include <ros/connection.h>

#include <atomic>
#include <boost/shared_array.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "self_awareness/ros/attribute_reader.h"
#include "self_awareness/ros/live/arrivals.h"
#include "self_awareness/ros/live/guarded.h"
#include "self_awareness/ros/live/read_limits.h"

namespace self_awareness::ros1 {

/// A connection to one publisher of one topic, which hands on what is published to Arrivals.
///
/// Speaks TCPROS by roscpp's connections, but not by its subscriptions: those allocate what a
/// publisher announces before a byte of it has come, and connect to whom somebody names on the
/// slave API of this node. Here memory follows what has come, up to ReadLimits, and a message that
/// nobody reads takes none.
///
/// Threads: that of roscpp's connections receives; all else is for one thread.
class TopicLink : public std::enable_shared_from_this<TopicLink> {
 public:
  /// Most bytes of a header; it has a definition of a message, of 1 MB at most
  /// (MessageDefinition).
  static constexpr std::uint32_t kMostHeader = 4000000;

  /// @param in_flight bytes of unfinished messages, of all links together
  /// @param arrivals must outlive the link, or close()
  TopicLink(std::shared_ptr<Arrival::Topic> topic, Arrivals& arrivals, const ReadLimits& limits,
            std::shared_ptr<std::atomic<std::size_t>> in_flight);
  ~TopicLink();
  TopicLink(const TopicLink&) = delete;
  TopicLink& operator=(const TopicLink&) = delete;

  /// Begins to connect. To be called once, when a shared pointer holds this.
  /// @param ip as a number: a name would be waited for
  void connect(const std::string& ip, int port);
  /// Nothing arrives any more.
  void close();

  /// Whether the publisher has answered, and the connection stands.
  bool stands() const { return answered_ && !lost_; }
  bool lost() const { return lost_; }
  /// When the last message came, by the steady clock [ns]; 0: none did.
  std::int64_t heardAt() const { return heard_at_; }
  /// Why it was lost.
  std::string why() const;

 private:
  struct Shared {
    bool closed = false;  // while it is locked with false, something may arrive
    std::string why;      // it was lost
  };
  using Bytes = boost::shared_array<std::uint8_t>;
  /// What is done with bytes that were read.
  using Step = void (TopicLink::*)(const Bytes& bytes, std::uint32_t size);

  void read(std::uint32_t size, Step next);
  void onHeaderLength(const Bytes& bytes, std::uint32_t size);
  void onHeader(const Bytes& bytes, std::uint32_t size);
  void onLength(const Bytes& bytes, std::uint32_t size);
  void onPart(const Bytes& bytes, std::uint32_t size);
  /// Goes on with the message, or hands it on if it is whole.
  void readOn();
  void handOn();
  /// Forgets what has come of the message; the rest of it goes by unread.
  void dropContent();
  void lose(const std::string& why);

  const std::shared_ptr<Arrival::Topic> topic_;
  Arrivals& arrivals_;
  const ReadLimits limits_;
  const std::shared_ptr<std::atomic<std::size_t>> in_flight_;
  ros::ConnectionPtr connection_;
  boost::shared_ptr<ros::M_string> header_;
  std::optional<AttributeReader> attributes_;  // of messages; none before the header has come
  std::uint32_t left_ = 0;                     // bytes of the message
  std::shared_ptr<Content> content_;           // of the message, so far; none: it is not read
  std::atomic<bool> answered_{false};
  std::atomic<bool> lost_{false};
  std::atomic<std::int64_t> heard_at_{0};
  Guarded<Shared> shared_;
};

}  // namespace self_awareness::ros1
