#pragma once

#include <memory>
#include <set>
#include <string>
#include <utility>

#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/siblings.h"

namespace self_awareness::ros1 {

/// What the monitor's own process publishes, and the other nodes of this package (Siblings): that
/// is no communication of the robot. In a manager that it shares with nodelets of the robot, the
/// monitor has their node name: only what the model does not know from that process is its own.
class OwnOutput {
 public:
  /// Topics that the model knows, by source.
  using Known = std::set<std::pair<std::string, std::string>>;

  OwnOutput() = default;  ///< nothing
  /// @param node full name of the monitor's process
  /// @param known what is communication of the robot
  /// @param encoder that its names come from; null: none are known
  OwnOutput(std::string node, Known known, std::shared_ptr<const Encoder> encoder = nullptr)
      : node_(std::move(node)), known_(std::move(known)), encoder_(std::move(encoder)) {}

  /// Takes in who publishes what now. To be called where the encoding tells sources apart, as a
  /// replay has one name for all.
  /// @return whether this changes what is covered
  bool setGraph(const Graph& graph);

  bool covers(const std::string& node, const std::string& topic) const;
  /// Whether setGraph() may have it covered later: a node of this package logs before it publishes
  /// what it is recognised by.
  bool mayCover(const std::string& node, const std::string& topic) const;

 private:
  bool knows(const std::string& node, const std::string& topic) const;

  std::string node_;
  Known known_;
  std::shared_ptr<const Encoder> encoder_;
  Siblings siblings_;
};

}  // namespace self_awareness::ros1
