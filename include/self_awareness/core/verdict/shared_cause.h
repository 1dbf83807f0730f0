#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace self_awareness::core {

/// No component is to blame, but the machine that they share: it keeps processes waiting, or so
/// many components are late at once (docs/method.md, section 6).
struct Busy {
  std::size_t late = 0;        ///< 0: none, or not enough to tell by them
  std::size_t components = 0;  ///< that are judged
  double starved = 0;          ///< for how long processes have been waiting [s]; 0: they do not
  std::int64_t since = 0;      ///< what was unusual before then has another cause [ns]
};

/// "the machine may be busy (load 7.9 on 2 cores): 12 of 26 components are late", or "the machine
/// has been starved for 1.2 s (load 7.9 on 2 cores)".
/// @param load of the machine, in words; empty: not known, as of a recording
std::string describe(const Busy& busy, const std::string& load = "");

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
