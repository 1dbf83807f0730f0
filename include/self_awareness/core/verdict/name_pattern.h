#pragma once

#include <string>

namespace self_awareness::core {

/// Whether a name is one that somebody has asked for.
/// @param pattern a name, or its begin and a `*`; empty: any
inline bool matchesPattern(const std::string& pattern, const std::string& name) {
  if (pattern.empty() || pattern.back() != '*') {
    return pattern.empty() || pattern == name;
  }
  return name.compare(0, pattern.size() - 1, pattern, 0, pattern.size() - 1) == 0;
}

}  // namespace self_awareness::core
