#pragma once

#include <memory>
#include <set>
#include <string>
#include <utility>

namespace self_awareness::ros1 {

class Encoder;
struct Graph;

/// Whether messages of this type come from a node of this package.
bool isOwnType(const std::string& datatype);

/// The nodes of this package: monitors, recorders and learners, whatever their names are. They
/// look at the robot and are no part of it. They are recognised by what they publish: a topic of a
/// type of this package.
class Siblings {
 public:
  /// Takes in that a node publishes messages of this type.
  /// @param node full name; empty: not known, and nobody is recognised by it
  void add(const std::string& node, const std::string& datatype);

  /// Whether a node, by its full name, is one of them.
  bool has(const std::string& node) const { return nodes_.count(node) > 0; }
  /// Whether this is what every node says of itself: /rosout or /diagnostics.
  static bool mayCover(const std::string& topic);
  /// Whether it is that, of one of them.
  bool cover(const std::string& node, const std::string& topic) const;

  friend bool operator==(const Siblings& a, const Siblings& b) { return a.nodes_ == b.nodes_; }
  friend bool operator!=(const Siblings& a, const Siblings& b) { return !(a == b); }

 private:
  std::set<std::string> nodes_;
};

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
