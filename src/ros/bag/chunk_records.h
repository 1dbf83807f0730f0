#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "bag_records.h"

namespace self_awareness::ros1 {

/// The records in a chunk, by their places in its data [bytes], whether that is compressed or not.
class ChunkRecords {
 public:
  /// Unpacks the chunk, if it is compressed.
  /// @throw rosbag::BagException if it cannot be unpacked, or the compression is unknown
  /// @throw std::bad_alloc if there is too little memory
  ChunkRecords(bag_records::PiecesOfFile& file, const bag_records::Chunk& chunk);

  /// The beginning of a record; valid until the next call of the file.
  /// @throw bag_records::FormatError if it is cut off
  bag_records::PiecesOfFile::Head head(std::uint64_t place) const;
  /// The data of a record; valid until the next call of the file.
  /// @param ahead so much more may be read for what follows [bytes]
  std::string_view data(const bag_records::PiecesOfFile::Head& head,
                        std::uint64_t ahead = 0) const;
  /// The beginning of a message, or of the one after a connection: an index may point there, too.
  bag_records::PiecesOfFile::Head message(std::uint64_t place) const;

 private:
  struct Free {
    void operator()(char* bytes) const { std::free(bytes); }
  };

  bag_records::PiecesOfFile* file_;
  std::uint64_t begin_;                   // of the data in the file [bytes]
  std::uint64_t size_;                    // of the data, unpacked [bytes]
  std::unique_ptr<char, Free> unpacked_;  // the data; none: it is not compressed
};

}  // namespace self_awareness::ros1
