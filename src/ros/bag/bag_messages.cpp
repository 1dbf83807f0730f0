#include "bag_messages.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <optional>
#include <utility>

#include "chunk_records.h"

namespace self_awareness::ros1 {
namespace {

using namespace bag_records;  // NOLINT: the format's words, in this file only

class MessagesOfChunks : public BagMessages {
 public:
  MessagesOfChunks(const std::string& path, std::vector<std::uint32_t> numbers,
                   std::uint64_t largest)
      : file_(path), numbers_(std::move(numbers)), largest_(largest) {}

  void read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content) override {
    if (!records_ || chunk_position_ != entry.chunk) {
      const Chunk chunk(file_, entry.chunk);
      if (chunk.isPacked() && chunk.unpacked_bytes > largest_) {
        throw FormatError("a chunk that announces too much");
      }
      records_.reset();  // the memory holds one
      records_.emplace(file_, chunk);
      chunk_position_ = entry.chunk;
    }
    const PiecesOfFile::Head head = records_->message(entry.offset);
    check(head.header, entry);
    const std::string_view bytes = records_->data(head);
    content.assign(bytes.begin(), bytes.end());
  }

 private:
  /// The message must be the one that the index says.
  void check(std::string_view header, const BagIndexEntry& entry) const {
    const MessageHeader message = messageHeader(header);
    if (message.stamp != entry.stamp || message.connection != numbers_.at(entry.connection)) {
      throw FormatError("its index and its messages contradict each other");
    }
  }

  PiecesOfFile file_;
  std::vector<std::uint32_t> numbers_;   // of the connections, in the file
  std::uint64_t largest_;                // that a chunk may be when it is unpacked [bytes]
  std::optional<ChunkRecords> records_;  // of the chunk that was read last
  std::uint64_t chunk_position_ = 0;
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
