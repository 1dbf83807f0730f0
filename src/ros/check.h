#pragma once

#include <stdexcept>

namespace self_awareness::ros1 {

/// Checks what a file says.
/// @param otherwise in words, where it does not hold; no string is made where it does: some things
/// are checked for every number of a model
/// @throw std::invalid_argument
inline void check(bool holds, const char* otherwise) {
  if (!holds) {
    throw std::invalid_argument(otherwise);
  }
}

}  // namespace self_awareness::ros1
