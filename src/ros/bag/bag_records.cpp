#include "bag_records.h"

#include <rosbag/chunked_file.h>

#include <algorithm>
#include <boost/filesystem/operations.hpp>
#include <new>

#include "../text.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::ros1::bag_records {
namespace {

constexpr std::uint64_t kLengthBytes = sizeof(std::uint32_t);  // of a length in the file
// Read together with what is asked for: most headers and messages are short.
constexpr std::uint64_t kReadAhead = 1024;

rosbag::CompressionType compressionOf(const Chunk& chunk) {
  if (chunk.compression == "bz2") {
    return rosbag::compression::BZ2;
  }
  if (chunk.compression == "lz4") {
    return rosbag::compression::LZ4;
  }
  throw FormatError("unknown compression " + quote(chunk.compression));
}

}  // namespace

PiecesOfFile::PiecesOfFile(const std::string& path) {
  file_.rdbuf()->pubsetbuf(nullptr, 0);
  // To open a pipe would wait for its writer.
  if (boost::system::error_code error; boost::filesystem::is_regular_file(path, error)) {
    file_.open(path, std::ios::binary | std::ios::ate);
  }
  size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(file_.tellg(), 0));
}

std::string_view PiecesOfFile::at(std::uint64_t position, std::uint64_t bytes,
                                  std::uint64_t ahead) {
  if (position > size_) {
    throw FormatError("a position beyond the end of the file");
  }
  bytes = std::min(bytes, size_ - position);
  if (position < position_ || position + bytes > position_ + buffer_.size()) {
    position_ = position;
    buffer_.resize(std::min(bytes + ahead, size_ - position));
    file_.seekg(static_cast<std::streamoff>(position));
    if (!file_.read(&buffer_[0], static_cast<std::streamsize>(buffer_.size()))) {
      throw FormatError("the file cannot be read");
    }
  }
  return std::string_view(buffer_).substr(position - position_, bytes);
}

PiecesOfFile::Head PiecesOfFile::head(std::uint64_t position) {
  std::string_view bytes = at(position, kLengthBytes, kReadAhead);
  const std::uint64_t size = kLengthBytes + takeNumber<std::uint32_t>(bytes) + kLengthBytes;
  if (size > kLargestHeader) {
    throw FormatError("a header that is too long");
  }
  bytes = at(position, size, kReadAhead);
  Head head;
  head.header = takeBlock(bytes);
  head.data = position + size;
  head.end = head.data + takeNumber<std::uint32_t>(bytes);
  return head;
}

PiecesOfFile::Record PiecesOfFile::record(std::uint64_t position, std::uint64_t most) {
  const Head begin = head(position);
  if (begin.end - begin.data > most) {
    throw FormatError("a record that is too long");
  }
  std::string_view bytes = at(position, begin.end - position, kReadAhead);
  Record record;
  record.header = takeBlock(bytes);
  record.data = takeBlock(bytes);
  record.end = begin.end;
  return record;
}

std::int64_t takeTime(std::string_view& bytes) {
  const std::int64_t seconds = takeNumber<std::uint32_t>(bytes);
  const std::int64_t nanoseconds = takeNumber<std::uint32_t>(bytes);
  if (nanoseconds >= core::kNanosecondsPerSecond) {
    throw FormatError("a time that cannot be");
  }
  return seconds * core::kNanosecondsPerSecond + nanoseconds;
}

std::int64_t timeIn(std::string_view header, std::string_view name) {
  std::string_view time = field(header, name);
  return takeTime(time);
}

MessageHeader messageHeader(std::string_view header) {
  if (opOf(header) != Op::kMessage) {
    throw FormatError("a record of another kind");
  }
  return {number<std::uint32_t>(header, "conn"), timeIn(header, "time")};
}

Chunk::Chunk(PiecesOfFile& file, std::uint64_t position) {
  const PiecesOfFile::Head head = file.head(position);
  if (opOf(head.header) != Op::kChunk) {
    throw FormatError("a record of another kind");
  }
  // The format leaves the order of the fields open. Python's rosbag begins with the operation;
  // that in C++ writes them in alphabetical order.
  std::string_view fields = head.header;
  by_python = takeField(fields).first == "op";
  compression = field(head.header, "compression");
  unpacked_bytes = number<std::uint32_t>(head.header, "size");
  begin = head.data;
  end = head.end;
  if (end > file.size()) {
    throw FormatError("a chunk is cut off");
  }
  const std::uint64_t size = end - begin;
  // What LZ4 and bzip2 make of zeros: nothing is packed into less.
  constexpr std::uint64_t kLz4 = 255;
  constexpr std::uint64_t kBz2 = 25000;
  const std::uint64_t most = compression == "lz4" ? kLz4 : compression == "bz2" ? kBz2 : 1;
  if (unpacked_bytes > kLargestChunk || unpacked_bytes > most * size) {
    throw FormatError("a chunk that announces too much");
  }
}

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

}  // namespace self_awareness::ros1::bag_records
