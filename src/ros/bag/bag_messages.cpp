#include "bag_messages.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <list>
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
    const ChunkRecords& records = this->records(entry.chunk);
    const std::string_view bytes = records.data(head(records, entry));
    content.assign(bytes.begin(), bytes.end());
  }

  void pass(const BagIndexEntry& entry, AttributeReader& reader) override {
    const ChunkRecords& records = this->records(entry.chunk);
    const PiecesOfFile::Head message = head(records, entry);
    const std::uint64_t size = message.end - message.data;
    reader.begin(size);
    for (AttributeReader::Part part = reader.next(); part.begin < part.end; part = reader.next()) {
      // A message that is not much longer is read at once.
      part.end = size <= kAtOnce ? size : part.end;
      PiecesOfFile::Head piece = message;
      piece.data = message.data + part.begin;
      piece.end = message.data + part.end;
      const std::string_view bytes = records.data(piece, size <= kAtOnce ? kAhead : 0);
      reader.skipTo(part.begin);
      reader.add(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }
  }

 private:
  static constexpr std::uint64_t kAtOnce = 8192;  // [bytes]
  // After a small message, more small ones follow: one call of the system reads many.
  static constexpr std::uint64_t kAhead = 8192;  // [bytes]

  // Messages may come from several chunks in turn: in memory, unpacked, these have together at
  // most so many bytes, but for a single one.
  static constexpr std::uint64_t kMostUnpacked = std::uint64_t{64} << 20U;
  static constexpr std::size_t kMostChunks = 64;

  struct KeptChunk {
    std::uint64_t position = 0;
    std::uint64_t unpacked = 0;  // in memory [bytes]
    std::unique_ptr<const ChunkRecords> records;
  };

  /// The records of a chunk.
  const ChunkRecords& records(std::uint64_t position) {
    const auto kept = std::find_if(chunks_.begin(), chunks_.end(), [&](const KeptChunk& chunk) {
      return chunk.position == position;
    });
    if (kept != chunks_.end()) {
      chunks_.splice(chunks_.begin(), chunks_, kept);
      return *chunks_.front().records;
    }
    const Chunk chunk(file_, position);
    if (chunk.isPacked() && chunk.unpacked_bytes > largest_) {
      throw FormatError("a chunk that announces too much");
    }
    const std::uint64_t unpacked = chunk.isPacked() ? chunk.unpacked_bytes : 0;
    makeRoom(unpacked);
    chunks_.push_front({position, unpacked, std::make_unique<const ChunkRecords>(file_, chunk)});
    unpacked_ += unpacked;
    return *chunks_.front().records;
  }

  /// Forgets those that were read longest ago, until there is room for another one.
  void makeRoom(std::uint64_t unpacked) {
    while (!chunks_.empty() &&
           (unpacked_ + unpacked > kMostUnpacked || chunks_.size() >= kMostChunks)) {
      unpacked_ -= chunks_.back().unpacked;
      chunks_.pop_back();
    }
  }

  /// Where a message lies.
  PiecesOfFile::Head head(const ChunkRecords& records, const BagIndexEntry& entry) const {
    const PiecesOfFile::Head found = records.message(entry.offset);
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
  std::vector<std::uint32_t> numbers_;  // of the connections, in the file
  std::uint64_t largest_;               // that a chunk may be when it is unpacked [bytes]
  std::list<KeptChunk> chunks_;         // that was read last first
  std::uint64_t unpacked_ = 0;          // of all of them [bytes]
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
