#pragma once

#include <cstddef>
#include <string>

namespace self_awareness::core {

/// So many components are late at once that none of them is to blame, but the machine that they
/// share (docs/method.md, section 6).
struct Busy {
  std::size_t late = 0;
  std::size_t components = 0;  ///< that are judged
};

/// "the machine may be busy (load 7.9 on 2 cores): 12 of 26 components are late".
/// @param load of the machine, in words; empty: not known, as of a recording
std::string describe(const Busy& busy, const std::string& load = "");

}  // namespace self_awareness::core
