#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "self_awareness/ros/encoding.h"

/// The index of a bag: one array in order. rosbag has a tree for every connection, 64 bytes a
/// message, and merges them in every pass, by sorting all connections at every message. To build,
/// merge and free its trees takes four times as long as to read this array.
namespace self_awareness::ros1 {

/// When a message came, and where it lies.
struct BagIndexEntry {
  std::int64_t stamp = 0;        ///< [ns]
  std::uint64_t chunk = 0;       ///< position of its chunk in the file [bytes]
  std::uint32_t offset = 0;      ///< in the chunk, unpacked [bytes]
  std::uint32_t connection = 0;  ///< index of its connection
};

/// In the order of the recording. A type and not a function, so that std::sort can inline it:
/// sorting takes most of the time here.
struct Earlier {
  bool operator()(const BagIndexEntry& a, const BagIndexEntry& b) const {
    if (a.stamp != b.stamp) {
      return a.stamp < b.stamp;
    }
    return std::tie(a.chunk, a.offset) < std::tie(b.chunk, b.offset);
  }
};

struct BagIndex {
  std::vector<Connection> connections;
  std::vector<std::uint32_t> numbers;  ///< of the connections, in the file
  /// In the order of the recording: by time, and in the order of the file where that is the same.
  std::vector<BagIndexEntry> entries;
  std::uint64_t timeless = 0;  ///< messages with the time 0: rosbag, too, leaves them out
  bool by_python = false;      ///< rosbag's Python library wrote it
  bool recorded = false;       ///< its connections have headers as `rosbag record` writes them
};

/// Called with the number of chunks that were checked, and of all; may throw to stop.
using ChunkProgress = std::function<void(std::uint64_t done, std::uint64_t all)>;

/// Only the connections, which takes no time even where the bag is large.
/// @throw rosbag::BagException if the file is no bag of format 2.0, has no index, or it is damaged
std::vector<Connection> readBagConnections(const std::string& path);

/// What the end of a bag says of its messages.
struct BagSpan {
  std::int64_t start = 0;      ///< stamp of the first message [ns]
  std::int64_t end = 0;        ///< stamp of the last message [ns]
  std::uint64_t messages = 0;  ///< 0: it is empty
};

/// Reads neither messages nor their index, which takes no time even where the bag is large. So not
/// every damage is found.
/// @throw rosbag::BagException as readBagConnections()
BagSpan readBagSpan(const std::string& path);

/// Checks the index as well: it must list every chunk, once, and in it as many messages as it
/// says, each in a place of its own. Where the chunk is not compressed, the messages themselves
/// must say the same, and its connections what the bag says of them. What is read follows the size
/// of the file, whatever the numbers in it say.
/// @param unpack compressed chunks as well, and check what is in them, which takes most of the
/// time where there are any
/// @throw rosbag::BagException as readBagConnections()
BagIndex readBagIndex(const std::string& path, bool unpack = false,
                      const ChunkProgress& progress = nullptr);

}  // namespace self_awareness::ros1
