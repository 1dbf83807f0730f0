#pragma once

#include <string>
#include <vector>

#include "name_patterns.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {

/// Replaces names of nodes and topics: what is learned on one robot is about another one that has
/// other names (docs/robots.md).
class NameRenames {
 public:
  /// @throw std::invalid_argument names the rule whose pattern is no regular expression, or whose
  /// new name does not begin with a slash, or names groups that the pattern lacks
  explicit NameRenames(const std::vector<Rename>& renames);

  /// The name by the first rule that matches all of it; as it is if none does.
  std::string apply(const std::string& name) const;

 private:
  NamePatterns patterns_;
  std::vector<std::string> names_;  // by pattern
};

}  // namespace self_awareness::ros1
