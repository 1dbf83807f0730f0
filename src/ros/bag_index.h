#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "self_awareness/ros/encoding.h"

/// The index of a bag, and the messages that it points to. rosbag's own index keeps every message
/// in a tree of its own, 64 bytes each, and costs most of the time that reading a bag's index
/// takes; this one is an array. What it does not understand (bags of format 1.2, encrypted or
/// damaged ones) and what is compressed is left to rosbag.
namespace self_awareness::ros1 {

/// When a message came, and where it lies.
struct BagIndexEntry {
  std::int64_t stamp = 0;        ///< [ns]
  std::uint64_t chunk = 0;       ///< position of its chunk in the file [bytes]
  std::uint32_t offset = 0;      ///< in the chunk, unpacked [bytes]
  std::uint32_t connection = 0;  ///< index of its connection
};

struct BagIndex {
  std::vector<Connection> connections;
  /// In the order of the recording: by time, and in the order of the file where that is the same.
  std::vector<BagIndexEntry> entries;
};

/// @throw rosbag::BagException if the bag has no index or it is damaged
BagIndex readBagIndex(const std::string& path);

/// Reads messages' contents.
class BagMessages {
 public:
  explicit BagMessages(const std::string& path);
  ~BagMessages();

  /// Reads one message, and no more of its chunk unless that is compressed. A compressed chunk is
  /// unpacked once for all messages of it that are read one after the other.
  /// @throw rosbag::BagException if it cannot be read
  void read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content);

 private:
  class Plain;
  class Rosbag;

  std::string path_;
  std::unique_ptr<Plain> plain_;
  std::unique_ptr<Rosbag> rosbag_;  // opened when it is needed
};

}  // namespace self_awareness::ros1
