#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace self_awareness::core {

/// Whether a name is one that somebody has asked for.
/// @param pattern a name, or its begin and a `*`; empty: any
inline bool matchesPattern(const std::string& pattern, const std::string& name) {
  if (pattern.empty() || pattern.back() != '*') {
    return pattern.empty() || pattern == name;
  }
  return name.compare(0, pattern.size() - 1, pattern, 0, pattern.size() - 1) == 0;
}

/// Whether one of the patterns is of an event type: names its component or its topic.
inline bool isOneOf(const std::vector<std::string>& patterns, const std::string& component,
                    const std::string& topic) {
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
    return matchesPattern(pattern, component) || matchesPattern(pattern, topic);
  });
}

}  // namespace self_awareness::core
