#include "bag_messages.h"

#include <rosbag/bag.h>
#include <rosbag/chunked_file.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <optional>
#include <utility>

namespace self_awareness::ros1 {
namespace {

using namespace bag_records;  // NOLINT: the format's words, in this file only

void assign(std::vector<std::uint8_t>& content, std::string_view bytes) {
  content.assign(bytes.begin(), bytes.end());
}

class MessagesOfChunks : public BagMessages {
 public:
  MessagesOfChunks(const std::string& path, std::vector<std::uint32_t> numbers,
                   std::uint64_t largest)
      : file_(path), numbers_(std::move(numbers)), largest_(largest) {}

  void read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content) override {
    if (!chunk_ || chunk_position_ != entry.chunk) {
      const Chunk chunk(file_, entry.chunk);
      chunk_.reset();
      unpack(chunk);
      chunk_ = chunk;
      chunk_position_ = entry.chunk;
    }
    if (chunk_->compression == "none") {
      const PiecesOfFile::Head head = headOfMessage(file_, chunk_->begin + entry.offset);
      check(head.header, entry);
      const std::uint64_t size = head.end - head.data;
      if (head.end > chunk_->end) {
        throw FormatError("a message is cut off");
      }
      std::string_view bytes = file_.at(head.data, size);
      assign(content, take(bytes, size));
      return;
    }
    std::string_view bytes(unpacked_.get(), chunk_->unpacked_bytes);
    take(bytes, entry.offset);
    std::string_view header = takeBlock(bytes);
    while (opOf(header) == Op::kConnection) {
      takeBlock(bytes);
      header = takeBlock(bytes);
    }
    check(header, entry);
    assign(content, takeBlock(bytes));
  }

 private:
  /// The message must be the one that the index says.
  void check(std::string_view header, const BagIndexEntry& entry) const {
    const MessageHeader message = messageHeader(header);
    if (message.stamp != entry.stamp || message.connection != numbers_.at(entry.connection)) {
      throw FormatError("its index and its messages contradict each other");
    }
  }

  void unpack(const Chunk& chunk) {
    if (chunk.compression == "none") {
      return;
    }
    if (chunk.compression != "bz2" && chunk.compression != "lz4") {
      throw FormatError("unknown compression: " + chunk.compression);
    }
    if (chunk.unpacked_bytes > largest_) {
      throw FormatError("a chunk that announces too much");
    }
    std::string packed(file_.at(chunk.begin, chunk.end - chunk.begin));
    // calloc() takes no memory for zeros that nobody writes: the chunk may hold less than it says.
    unpacked_.reset(static_cast<char*>(std::calloc(std::max(chunk.unpacked_bytes, 1U), 1)));
    if (!unpacked_) {
      throw std::bad_alloc();
    }
    rosbag::ChunkedFile().decompress(
        chunk.compression == "bz2" ? rosbag::compression::BZ2 : rosbag::compression::LZ4,
        reinterpret_cast<std::uint8_t*>(unpacked_.get()), chunk.unpacked_bytes,
        reinterpret_cast<std::uint8_t*>(&packed[0]), static_cast<unsigned int>(packed.size()));
  }

  struct Free {
    void operator()(char* bytes) const { std::free(bytes); }
  };

  PiecesOfFile file_;
  std::vector<std::uint32_t> numbers_;  // of the connections, in the file
  std::uint64_t largest_;               // that a chunk may be when it is unpacked [bytes]
  std::optional<Chunk> chunk_;          // the one that was read last
  std::uint64_t chunk_position_ = 0;
  std::unique_ptr<char, Free> unpacked_;  // its data, if it is compressed
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

std::unique_ptr<BagMessages> BagMessages::open(const std::string& path, const BagIndex& index,
                                               std::uint64_t largest) {
  if (index.by_rosbag) {
    return std::make_unique<MessagesOfRosbag>(path);
  }
  return std::make_unique<MessagesOfChunks>(path, index.numbers, largest);
}

}  // namespace self_awareness::ros1
