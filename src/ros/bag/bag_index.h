#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "self_awareness/ros/encoding.h"

/// The index of a bag. That of rosbag is a tree for every connection, 64 bytes a message, which
/// must be merged for every pass, by sorting all connections at every message; to build, merge and
/// free them takes four times as long as to read this one, an array in order. What cannot be read
/// here (format 1.2 and encrypted bags) is left to rosbag.
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
  bool by_rosbag = false;  ///< only rosbag can read this bag
};

/// @throw rosbag::BagException if the bag has no index or it is damaged
BagIndex readBagIndex(const std::string& path);

}  // namespace self_awareness::ros1
