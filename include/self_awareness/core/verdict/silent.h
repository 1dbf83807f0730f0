#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace self_awareness::core {

/// No component is to blame, but what they share: all of them fell silent, or all that run on some
/// computers, or so many that do not hear each other that the robot is in another mode
/// (docs/method.md, section 6).
struct Silent {
  std::vector<std::string> hosts;  ///< the computers, in order; empty: nobody is heard any more
  std::vector<std::string> components;  ///< that fell silent, in order
  std::int64_t since = 0;               ///< stamp of the last event of them [ns]
  /// Others are heard, on whatever computers: a mode that training did not show.
  bool others_go_on = false;

  /// Whether a component is one of them.
  bool has(const std::string& component) const;
};

/// "everything on host base fell silent: 5 nodes", "everything fell silent: 9 components", or "/a,
/// /b, /c and 4 more stopped together, and others go on: a mode that training did not show, or
/// something that they share".
std::string describe(const Silent& silent);

}  // namespace self_awareness::core
