#include "chunk_records.h"

#include <rosbag/chunked_file.h>

#include <algorithm>
#include <new>
#include <string>

#include "../text.h"

namespace self_awareness::ros1 {

using namespace bag_records;  // NOLINT: the format's words, in this file only

namespace {

constexpr std::size_t kLongestCompression = 32;  // [bytes]

rosbag::CompressionType compressionOf(const Chunk& chunk) {
  if (chunk.compression == "bz2") {
    return rosbag::compression::BZ2;
  }
  if (chunk.compression == "lz4") {
    return rosbag::compression::LZ4;
  }
  throw FormatError("unknown compression '" + printable(chunk.compression, kLongestCompression) +
                    "'");
}

}  // namespace

ChunkRecords::ChunkRecords(PiecesOfFile& file, const Chunk& chunk)
    : file_(&file), begin_(chunk.begin), size_(chunk.end - chunk.begin) {
  if (!chunk.isPacked()) {
    return;
  }
  const rosbag::CompressionType compression = compressionOf(chunk);
  std::string packed(file.at(chunk.begin, chunk.end - chunk.begin));
  size_ = chunk.unpacked_bytes;
  // calloc() takes no memory for zeros that nobody writes: the chunk may hold less than it says.
  unpacked_.reset(static_cast<char*>(std::calloc(std::max<std::size_t>(size_, 1), 1)));
  if (!unpacked_) {
    throw std::bad_alloc();
  }
  rosbag::ChunkedFile().decompress(
      compression, reinterpret_cast<std::uint8_t*>(unpacked_.get()), chunk.unpacked_bytes,
      reinterpret_cast<std::uint8_t*>(&packed[0]), static_cast<unsigned int>(packed.size()));
}

PiecesOfFile::Head ChunkRecords::head(std::uint64_t place) const {
  PiecesOfFile::Head head;
  if (unpacked_) {
    std::string_view bytes(unpacked_.get(), size_);
    take(bytes, place);
    head.header = takeBlock(bytes);
    const auto size = takeNumber<std::uint32_t>(bytes);
    head.data = size_ - bytes.size();
    head.end = head.data + size;
  } else {
    head = file_->head(begin_ + place);
    head.data -= begin_;
    head.end -= begin_;
  }
  if (head.end > size_) {
    throw FormatError("a message is cut off");
  }
  return head;
}

std::string_view ChunkRecords::data(const PiecesOfFile::Head& head, std::uint64_t ahead) const {
  const std::uint64_t size = head.end - head.data;
  std::string_view bytes = unpacked_ ? std::string_view(unpacked_.get() + head.data, size)
                                     : file_->at(begin_ + head.data, size, ahead);
  return take(bytes, size);
}

PiecesOfFile::Head ChunkRecords::message(std::uint64_t place) const {
  PiecesOfFile::Head found = head(place);
  while (opOf(found.header) == Op::kConnection) {
    found = head(found.end);
  }
  return found;
}

}  // namespace self_awareness::ros1
