#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

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

}  // namespace self_awareness::core
