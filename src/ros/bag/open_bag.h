#pragma once

#include <string>

#include "bag_index.h"

namespace self_awareness::ros1 {

/// The index of a bag, whose compressed chunks are checked as well.
/// @throw BagError if the file is missing, no bag, unindexed, truncated or damaged
BagIndex openBag(const std::string& path, const ChunkProgress& progress = nullptr);

/// The same without its messages and their index, which takes no time even where the bag is large.
/// @throw BagError as openBag(); not every damage is found
BagSpan spanOfBag(const std::string& path);

/// What to do about a damaged bag: the end of an error message.
std::string reindexHint(const std::string& path);

}  // namespace self_awareness::ros1
