#pragma once

#include <set>
#include <string>

namespace self_awareness::ros1 {

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

}  // namespace self_awareness::ros1
