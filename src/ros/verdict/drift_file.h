#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "self_awareness/KeptDrift.h"

namespace self_awareness::ros1 {

/// At most so many shares are kept, and samples: of 60 components, 5000 starts or days.
constexpr std::size_t kMostDriftShares = 500000;
constexpr std::size_t kMostDriftSamples = 5000;

/// The file beside a model that says how near its components came to their limits
/// (docs/learn_more.md).
std::string pathOfDrift(const std::string& model);

/// Writes the whole file or nothing (see OutputFile).
/// @throw FileError or BagError if it cannot be written
void writeDrift(const self_awareness::KeptDrift& drift, const std::string& path);

/// Reads such a file, and checks what is in it.
/// @return none: there is no file
/// @throw BagError if it is damaged, or no such file; names it
std::optional<self_awareness::KeptDrift> readDrift(const std::string& path);

}  // namespace self_awareness::ros1
