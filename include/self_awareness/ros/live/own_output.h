#pragma once

#include <set>
#include <string>
#include <utility>

namespace self_awareness::ros1 {

/// What the monitor's own process publishes, which is no communication of the robot. In a manager
/// that it shares with nodelets of the robot, the monitor has their node name: only what the model
/// does not know from that process is its own.
class OwnOutput {
 public:
  OwnOutput() = default;  ///< nothing
  /// @param node full name of the monitor's process
  /// @param model_topics where the model knows events of that process
  OwnOutput(std::string node, std::set<std::string> model_topics)
      : node_(std::move(node)), model_topics_(std::move(model_topics)) {}

  bool covers(const std::string& node, const std::string& topic) const {
    return node == node_ &&
           (topic == "/rosout" || topic == "/diagnostics" || model_topics_.count(topic) == 0);
  }

 private:
  std::string node_;
  std::set<std::string> model_topics_;
};

}  // namespace self_awareness::ros1
