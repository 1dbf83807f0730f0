#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace self_awareness::ros1 {

/// What the end of a bag says of its messages.
struct BagSpan {
  std::int64_t start = 0;      ///< stamp of the first message [ns]
  std::int64_t end = 0;        ///< stamp of the last message [ns]
  std::uint64_t messages = 0;  ///< 0: it is empty
};

/// Looks at a bag's file without reading its messages or their index, which takes no time even
/// where it is large. So not every damage is found.
/// @throw BagError if the file is missing, no bag, unindexed, or damaged where it is looked at
BagSpan spanOfBag(const std::string& path);

/// The same of a bag of format 2.0; none if it is of another one.
/// @throw rosbag::BagException if the bag has no index, or it is damaged
std::optional<BagSpan> readSpanOfFormat2(const std::string& path);

}  // namespace self_awareness::ros1
