#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bag_index.h"
#include "bag_records.h"
#include "self_awareness/ros/attribute_reader.h"

namespace self_awareness::ros1 {

/// Reads the contents of a bag's messages. rosbag reads the whole chunk around a message; this
/// class reads the message alone, unless the chunk is compressed. The last few of such chunks stay
/// unpacked.
class BagMessages {
 public:
  virtual ~BagMessages() = default;

  /// @throw rosbag::BagException if it cannot be read, or is not the one that the index says
  virtual void read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content) = 0;
  /// Passes a message by a reader of attributes, whose begin() it calls, but not its end(); where
  /// the message is not compressed, only the bytes that matter are read.
  /// @throw rosbag::BagException as read()
  virtual void pass(const BagIndexEntry& entry, AttributeReader& reader) = 0;

  /// The messages of the bag that the index was read from.
  /// @param largest that a compressed chunk may be when it is unpacked [bytes]
  static std::unique_ptr<BagMessages> open(const std::string& path, const BagIndex& index,
                                           std::uint64_t largest = bag_records::kLargestChunk);
};

}  // namespace self_awareness::ros1
