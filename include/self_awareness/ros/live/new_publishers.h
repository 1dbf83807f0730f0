#pragma once

#include <functional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "self_awareness/ros/graph.h"

namespace self_awareness::ros1 {

/// A node as a publisher of one topic.
struct Publisher {
  std::string source;  ///< the node's stable name
  std::string topic;
};

inline bool operator<(const Publisher& a, const Publisher& b) {
  return std::tie(a.source, a.topic) < std::tie(b.source, b.topic);
}

/// Notices publishers that register after the start. Each is new once, by its stable name: a node
/// that crashes and is restarted again and again is not.
class NewPublishers {
 public:
  /// Those that the next look finds are not new.
  void restart();

  /// @param graph what the master knows now
  /// @param topics that are subscribed to
  /// @param included whether messages of a node (full name) on a topic may be events
  /// @return those that are new and heard; one that is not subscribed to is new when it is
  std::vector<Publisher> look(
      const Graph& graph, const std::set<std::string>& topics,
      const std::function<bool(const std::string& node, const std::string& topic)>& included);

 private:
  bool started_ = false;
  std::set<Publisher> known_;
};

}  // namespace self_awareness::ros1
