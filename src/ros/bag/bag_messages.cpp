#include "bag_messages.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <memory>
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
    const std::string_view bytes = records(entry).data(head(entry));
    content.assign(bytes.begin(), bytes.end());
  }

  void pass(const BagIndexEntry& entry, AttributeReader& reader) override {
    const PiecesOfFile::Head message = head(entry);
    const std::uint64_t size = message.end - message.data;
    reader.begin(size);
    for (AttributeReader::Part part = reader.next(); part.begin < part.end; part = reader.next()) {
      // A message that is not much longer is read at once.
      part.end = size <= kAtOnce ? size : part.end;
      PiecesOfFile::Head piece = message;
      piece.data = message.data + part.begin;
      piece.end = message.data + part.end;
      const std::string_view bytes = records_->data(piece, size <= kAtOnce ? kAhead : 0);
      reader.skipTo(part.begin);
      reader.add(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }
  }

 private:
  static constexpr std::uint64_t kAtOnce = 8192;  // [bytes]
  // After a small message, more small ones follow: one call of the system reads many.
  static constexpr std::uint64_t kAhead = 8192;  // [bytes]

  /// The records of the chunk that a message is in.
  ChunkRecords& records(const BagIndexEntry& entry) {
    if (!records_ || chunk_position_ != entry.chunk) {
      const Chunk chunk(file_, entry.chunk);
      if (chunk.isPacked() && chunk.unpacked_bytes > largest_) {
        throw FormatError("a chunk that announces too much");
      }
      records_.reset();  // the memory holds one
      records_ = std::make_unique<ChunkRecords>(file_, chunk);
      chunk_position_ = entry.chunk;
    }
    return *records_;
  }

  /// Where a message lies.
  PiecesOfFile::Head head(const BagIndexEntry& entry) {
    const PiecesOfFile::Head found = records(entry).message(entry.offset);
    check(found.header, entry);
    return found;
  }

  /// The message must be the one that the index says.
  void check(std::string_view header, const BagIndexEntry& entry) const {
    const MessageHeader message = messageHeader(header);
    if (message.stamp != entry.stamp || message.connection != numbers_.at(entry.connection)) {
      throw FormatError("its index and its messages contradict each other");
    }
  }

  PiecesOfFile file_;
  std::vector<std::uint32_t> numbers_;     // of the connections, in the file
  std::uint64_t largest_;                  // that a chunk may be when it is unpacked [bytes]
  std::unique_ptr<ChunkRecords> records_;  // of the chunk that was read last
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

  void pass(const BagIndexEntry& entry, AttributeReader& reader) override {
    read(entry, content_);
    reader.begin(content_.size());
    reader.add(content_.data(), content_.size());
  }

 private:
  rosbag::Bag bag_;
  std::vector<std::uint8_t> content_;
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
