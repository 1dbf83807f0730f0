#pragma once

#include <cstdint>
#include <list>
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
  /// The messages of the bag that the index was read from.
  /// @param numbers of its connections (BagIndex)
  /// @param largest that a compressed chunk may be when it is unpacked [bytes]
  BagMessages(const std::string& path, std::vector<std::uint32_t> numbers,
              std::uint64_t largest = bag_records::kLargestChunk);

  /// @throw rosbag::BagException if it cannot be read, or is not the one that the index says
  void read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content);
  /// The attributes of a message; where it is not compressed, only the bytes that matter are read.
  /// @throw rosbag::BagException as read()
  core::Attributes attributes(const BagIndexEntry& entry, AttributeReader& reader);

 private:
  struct KeptChunk {
    std::uint64_t position = 0;
    std::uint64_t unpacked = 0;  // in memory [bytes]
    std::unique_ptr<const bag_records::ChunkRecords> records;
  };

  /// The records of a chunk.
  const bag_records::ChunkRecords& records(std::uint64_t position);
  /// Forgets those that were read longest ago, until there is room for another one.
  void makeRoom(std::uint64_t unpacked);
  /// Where a message lies; it must be the one that the index says.
  bag_records::PiecesOfFile::Head head(const bag_records::ChunkRecords& records,
                                       const BagIndexEntry& entry) const;

  bag_records::PiecesOfFile file_;
  std::vector<std::uint32_t> numbers_;  // of the connections, in the file
  std::uint64_t largest_;               // that a chunk may be when it is unpacked [bytes]
  std::list<KeptChunk> chunks_;         // that was read last first
  std::uint64_t unpacked_ = 0;          // of all of them [bytes]
};

}  // namespace self_awareness::ros1
