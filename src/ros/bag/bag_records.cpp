#include "bag_records.h"

#include <algorithm>
#include <boost/filesystem/operations.hpp>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::ros1::bag_records {
namespace {

constexpr std::uint64_t kLengthBytes = sizeof(std::uint32_t);  // of a length in the file
// Read together with what is asked for: most headers and messages are short.
constexpr std::uint64_t kReadAhead = 1024;

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

}  // namespace self_awareness::ros1::bag_records
