#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bag_index.h"

namespace self_awareness::ros1 {

/// Reads the contents of a bag's messages. rosbag reads the whole chunk around a message; this
/// class reads the message alone, unless the chunk is compressed. Such a chunk is unpacked once
/// for all of its messages that are read in a row.
class BagMessages {
 public:
  virtual ~BagMessages() = default;

  /// @throw rosbag::BagException if it cannot be read
  virtual void read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content) = 0;

  /// The messages of the bag that the index was read from.
  static std::unique_ptr<BagMessages> open(const std::string& path, const BagIndex& index);
};

}  // namespace self_awareness::ros1
