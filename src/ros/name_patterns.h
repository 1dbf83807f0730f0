#pragma once

#include <re2/re2.h>
#include <re2/stringpiece.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {

/// Regular expressions that names of topics or nodes match, in the syntax of RE2
/// (github.com/google/re2/wiki/Syntax). RE2 needs time that follows the length of the name, and
/// bounded memory, whatever the pattern: patterns come with models, and names from strangers.
class NamePatterns {
 public:
  /// Of what RE2 makes of a pattern [bytes]. The patterns of the defaults need a few kB.
  static constexpr int kMostMemory = 1 << 18;
  /// States of all patterns together: a name of 1000 bytes is matched in a fraction of a second.
  static constexpr int kMostStates = 200000;

  /// @throw std::invalid_argument names the pattern that is no regular expression, or too large
  explicit NamePatterns(const std::vector<std::string>& patterns);

  bool empty() const { return patterns_.empty(); }
  /// Whether one of them matches the whole name: with its first slash, or, as people type names,
  /// without it.
  bool match(const std::string& name) const { return firstThatMatches(name) != all().size(); }
  /// Index of the first one that matches the whole name; their number if none does.
  std::size_t firstThatMatches(const std::string& name) const;
  const std::vector<std::unique_ptr<const re2::RE2>>& all() const { return patterns_; }
  /// Whether one pattern does, and what its groups match.
  static bool matches(const re2::RE2& pattern, const std::string& name,
                      re2::StringPiece* groups = nullptr, int wanted = 0);

 private:
  std::vector<std::unique_ptr<const re2::RE2>> patterns_;
};

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
