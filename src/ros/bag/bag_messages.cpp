#include "bag_messages.h"

#include <rosbag/bag.h>
#include <rosbag/chunked_file.h>
#include <rosbag/view.h>

#include <optional>

#include "bag_records.h"

namespace self_awareness::ros1 {
namespace {

using namespace bag_records;  // NOLINT: the format's words, in this file only

constexpr std::uint64_t kShortMessageBytes = 1024;  // up to here, read together with its header

void assign(std::vector<std::uint8_t>& content, std::string_view bytes) {
  content.assign(bytes.begin(), bytes.end());
}

class MessagesOfChunks : public BagMessages {
 public:
  explicit MessagesOfChunks(const std::string& path) : file_(path) {}

  void read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content) override {
    if (!chunk_ || chunk_position_ != entry.chunk) {
      const Chunk chunk(file_, entry.chunk);
      chunk_.reset();
      unpack(chunk);
      chunk_ = chunk;
      chunk_position_ = entry.chunk;
    }
    if (chunk_->compression == "none") {
      std::uint64_t position = chunk_->begin + entry.offset;
      std::string_view bytes = file_.at(position, kHeaderBytes, kShortMessageBytes);
      while (const std::uint64_t size = connectionBytes(bytes)) {
        position += size;
        bytes = file_.at(position, kHeaderBytes, kShortMessageBytes);
      }
      const std::size_t all = bytes.size();
      const std::uint32_t size = takeMessageSize(bytes);
      bytes = file_.at(position + (all - bytes.size()), size);
      assign(content, take(bytes, size));
    } else {
      std::string_view bytes = unpacked_;
      take(bytes, entry.offset);
      while (const std::uint64_t size = connectionBytes(bytes)) {
        take(bytes, size);
      }
      const std::uint32_t size = takeMessageSize(bytes);
      assign(content, take(bytes, size));
    }
  }

 private:
  /// Size of the record that the bytes begin with if it is a connection's, else 0. An index may
  /// point at such a record before the message; rosbag skips it, too.
  static std::uint64_t connectionBytes(std::string_view bytes) {
    const std::size_t all = bytes.size();
    const std::string_view header = takeBlock(bytes);
    if (number<std::uint8_t>(header, "op") != static_cast<std::uint8_t>(Op::kConnection)) {
      return 0;
    }
    const auto data = takeNumber<std::uint32_t>(bytes);
    return all - bytes.size() + data;
  }

  static std::uint32_t takeMessageSize(std::string_view& bytes) {
    takeHeader(bytes, Op::kMessage);
    return takeNumber<std::uint32_t>(bytes);
  }

  void unpack(const Chunk& chunk) {
    if (chunk.compression == "none") {
      return;
    }
    if (chunk.compression != "bz2" && chunk.compression != "lz4") {
      throw FormatError("unknown compression: " + chunk.compression);
    }
    std::string packed(file_.at(chunk.begin, chunk.end - chunk.begin));
    unpacked_.resize(chunk.unpacked_bytes);
    rosbag::ChunkedFile().decompress(
        chunk.compression == "bz2" ? rosbag::compression::BZ2 : rosbag::compression::LZ4,
        reinterpret_cast<std::uint8_t*>(&unpacked_[0]), chunk.unpacked_bytes,
        reinterpret_cast<std::uint8_t*>(&packed[0]), static_cast<unsigned int>(packed.size()));
  }

  PiecesOfFile file_;
  std::optional<Chunk> chunk_;  // the one that was read last
  std::uint64_t chunk_position_ = 0;
  std::string unpacked_;  // its data, if it is compressed
};

class MessagesOfRosbag : public BagMessages, private rosbag::View {
 public:
  explicit MessagesOfRosbag(const std::string& path) : bag_(path, rosbag::bagmode::Read) {}

  void read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content) override {
    rosbag::IndexEntry place;
    place.time.fromNSec(static_cast<std::uint64_t>(entry.stamp));
    place.chunk_pos = entry.chunk;
    place.offset = entry.offset;
    // The place alone says where the content is; rosbag does not look at the connection.
    const std::unique_ptr<rosbag::MessageInstance> message(
        newMessageInstance(nullptr, place, bag_));
    content.resize(message->size());
    ros::serialization::OStream stream(content.data(), static_cast<std::uint32_t>(content.size()));
    message->write(stream);
  }

 private:
  rosbag::Bag bag_;
};

}  // namespace

std::unique_ptr<BagMessages> BagMessages::open(const std::string& path, const BagIndex& index) {
  if (index.by_rosbag) {
    return std::make_unique<MessagesOfRosbag>(path);
  }
  return std::make_unique<MessagesOfChunks>(path);
}

}  // namespace self_awareness::ros1
