#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "self_awareness/core/verdict/senders.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {

/// Watches over which connections messages come, live and in bags: events name their sender, which
/// may be two (docs/monitor.md).
///
/// Two connections of one sender on one topic are two processes of one name if messages come over
/// them in turn: who was started again never speaks over the old one. `rosbag record` makes one of
/// such connections; then the numbers of the messages (header.seq) tell: they go on in turn where
/// two processes count.
class SenderWatch {
 public:
  /// Told who sends from a time [ns] on, whenever that changes.
  using Handler = std::function<void(std::int64_t, const core::Senders&)>;
  /// Stands for a connection.
  class Link;

  explicit SenderWatch(Handler handler) : handler_(std::move(handler)) {}

  /// A connection from which messages will come; none: nothing is to be learned of it.
  std::shared_ptr<Link> connect(const Connection& connection, const Encoder& encoder);
  /// Takes in a message.
  /// @param stamp [ns], not before the one of the message before
  /// @param number of the message (header.seq); none: it has none
  void add(std::int64_t stamp, Link& link, std::optional<std::uint32_t> number);
  /// Takes note that it is so late [ns]; nothing came.
  void advance(std::int64_t stamp);
  /// Forgets who sent, and tells it. Connections have to be made again.
  void restart();

 private:
  struct Topic;

  void tell(std::int64_t stamp);

  Handler handler_;
  core::Senders told_;
  // By the node's full name and the topic, since nodes with other numbers may share a stable name.
  std::map<std::pair<std::string, std::string>, std::weak_ptr<Topic>> topics_;
  std::uint64_t links_ = 0;
  std::map<core::SourceGraph::Publication, std::int64_t> doubled_until_;  // [ns]
  std::map<core::EventType, std::int64_t> played_until_;                  // [ns]
};

}  // namespace self_awareness::ros1
