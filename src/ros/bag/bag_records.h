#pragma once

#include <rosbag/exceptions.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

/// The records that a bag of format 2.0 is made of (wiki.ros.org/Bags/Format/2.0): a header of
/// named fields, and data.
namespace self_awareness::ros1::bag_records {

/// The file does not follow the format.
using FormatError = rosbag::BagFormatException;

/// The bag is encrypted. rosbag could read it, but checks nothing that the file says.
class EncryptedError : public rosbag::BagException {
 public:
  EncryptedError() : rosbag::BagException("it is encrypted") {}
};

constexpr std::string_view kFormat = "#ROSBAG V2.0\n";  // at the beginning of the file
// Every writer fills header and data of the file's header up to this, so that they can be written
// again at the end; rosbag does not look how long they are.
constexpr std::size_t kFileHeaderBytes = 4096;

enum class Op : std::uint8_t {
  kMessage = 0x02,
  kFileHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07
};

/// Takes bytes from the front.
/// @throw FormatError if there are fewer
inline std::string_view take(std::string_view& bytes, std::size_t size) {
  if (size > bytes.size()) {
    throw FormatError("a record is cut off");
  }
  const std::string_view taken = bytes.substr(0, size);
  bytes.remove_prefix(size);
  return taken;
}

/// Takes a number: little endian, like the machines that ROS 1 runs on.
template <typename Number>
Number takeNumber(std::string_view& bytes) {
  Number value;
  std::memcpy(&value, take(bytes, sizeof value).data(), sizeof value);
  return value;
}

/// Takes as many bytes as the number before them says.
inline std::string_view takeBlock(std::string_view& bytes) {
  const auto size = takeNumber<std::uint32_t>(bytes);
  return take(bytes, size);
}

/// Takes a field from a header: its name and its value.
inline std::pair<std::string_view, std::string_view> takeField(std::string_view& header) {
  const std::string_view field = takeBlock(header);
  const std::size_t equals = field.find('=');
  if (equals == std::string_view::npos) {
    throw FormatError("a field without a name");
  }
  return {field.substr(0, equals), field.substr(equals + 1)};
}

/// A field of a header; none: there is no field of that name.
inline std::optional<std::string_view> findField(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const auto [here, value] = takeField(header);
    if (here == name) {
      return value;
    }
  }
  return std::nullopt;
}

/// @throw FormatError if there is no field of that name
inline std::string_view field(std::string_view header, std::string_view name) {
  if (const auto value = findField(header, name)) {
    return *value;
  }
  throw FormatError("no field " + std::string(name));
}

template <typename Number>
Number number(std::string_view header, std::string_view name) {
  std::string_view value = field(header, name);
  return takeNumber<Number>(value);
}

/// What kind of record a header is of; 0 and others may be no kind at all.
inline Op opOf(std::string_view header) {
  return static_cast<Op>(number<std::uint8_t>(header, "op"));
}

/// The least that the record of a message takes [bytes].
constexpr std::uint64_t kLeastMessageBytes = 46;

/// Bounds for what a file may ask for: its numbers may be wrong on purpose.
constexpr std::uint64_t kLargestHeader = 1 << 20;      ///< of a record [bytes]
constexpr std::uint64_t kLargestConnection = 1 << 22;  ///< data of its record [bytes]
constexpr std::uint64_t kMostConnections = 100000;     ///< of a bag, or in a chunk
/// Of a chunk, unpacked [bytes]. Writers begin a new one after 768 kB, and roscpp sends no message
/// of more than a billion bytes.
constexpr std::uint64_t kLargestChunk = 1 << 30;

/// Reads a file in pieces, and no more than is asked for: a stream's own buffer would read more.
class PiecesOfFile {
 public:
  explicit PiecesOfFile(const std::string& path);

  std::uint64_t size() const { return size_; }
  /// The bytes at a position, up to the end of the file; valid until the next call. Reads them,
  /// and `ahead` [bytes] more, if they are not in the buffer.
  /// @throw FormatError if the position lies beyond the end
  std::string_view at(std::uint64_t position, std::uint64_t bytes, std::uint64_t ahead = 0);

  /// The beginning of a record; valid until the next call.
  struct Head {
    std::string_view header;
    std::uint64_t data = 0;  ///< position of its data
    std::uint64_t end = 0;   ///< position after it, which may lie beyond the end of the file
  };
  /// @throw FormatError if it is cut off, or too long
  Head head(std::uint64_t position);

  /// A record; valid until the next call.
  struct Record {
    std::string_view header;
    std::string_view data;
    std::uint64_t end = 0;  ///< position after it
  };
  /// @param most that its data may have [bytes]
  /// @throw FormatError if it is larger, or is cut off
  Record record(std::uint64_t position, std::uint64_t most);

 private:
  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::string buffer_;
  std::uint64_t position_ = 0;  // of the buffer
};

/// Whose message a record holds, and when it came.
struct MessageHeader {
  std::uint32_t connection = 0;  ///< number
  std::int64_t stamp = 0;        ///< [ns]
};
/// @throw FormatError if it is the header of another kind of record
MessageHeader messageHeader(std::string_view header);

/// Takes a time [ns].
/// @throw FormatError if it has a second of nanoseconds, or more
std::int64_t takeTime(std::string_view& bytes);
/// A time in a field of a header [ns].
/// @throw FormatError as takeTime(), or if there is no field of that name
std::int64_t timeIn(std::string_view header, std::string_view name);

/// The header of a chunk.
struct Chunk {
  /// @throw FormatError if there is none, it is cut off, or it says what cannot be
  Chunk(PiecesOfFile& file, std::uint64_t position);

  bool isPacked() const { return compression != "none"; }

  bool by_python = false;            ///< rosbag's Python library wrote it, not that in C++
  std::string compression;           ///< "none", "bz2" or "lz4"; others are unknown
  std::uint32_t unpacked_bytes = 0;  ///< of the data
  std::uint64_t begin = 0;           ///< of the data in the file [bytes]
  std::uint64_t end = 0;
};

/// The records in a chunk, by their places in its data [bytes], whether that is compressed or not.
class ChunkRecords {
 public:
  /// Unpacks the chunk, if it is compressed.
  /// @throw rosbag::BagException if it cannot be unpacked, or the compression is unknown
  /// @throw std::bad_alloc if there is too little memory
  ChunkRecords(PiecesOfFile& file, const Chunk& chunk);

  /// The beginning of a record; valid until the next call of the file.
  /// @throw FormatError if it is cut off
  PiecesOfFile::Head head(std::uint64_t place) const;
  /// The data of a record; valid until the next call of the file.
  /// @param ahead so much more may be read for what follows [bytes]
  std::string_view data(const PiecesOfFile::Head& head, std::uint64_t ahead = 0) const;
  /// The beginning of a message, or of the one after a connection: an index may point there, too.
  PiecesOfFile::Head message(std::uint64_t place) const;

 private:
  struct Free {
    void operator()(char* bytes) const { std::free(bytes); }
  };

  PiecesOfFile* file_;
  std::uint64_t begin_;                   // of the data in the file [bytes]
  std::uint64_t size_;                    // of the data, unpacked [bytes]
  std::unique_ptr<char, Free> unpacked_;  // the data; none: it is not compressed
};

}  // namespace self_awareness::ros1::bag_records
