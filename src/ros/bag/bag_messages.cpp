#include "bag_messages.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace self_awareness::ros1 {

using namespace bag_records;  // NOLINT: the format's words, in this file only

constexpr std::uint64_t kAtOnce = 8192;  // [bytes]
// After a small message, more small ones follow: one call of the system reads many.
constexpr std::uint64_t kAhead = 8192;  // [bytes]
// Messages may come from several chunks in turn: in memory, unpacked, these have together at
// most so many bytes, but for a single one.
constexpr std::uint64_t kMostUnpacked = std::uint64_t{64} << 20U;
constexpr std::size_t kMostChunks = 64;

BagMessages::BagMessages(const std::string& path, std::vector<std::uint32_t> numbers,
                         std::uint64_t largest)
    : file_(path), numbers_(std::move(numbers)), largest_(largest) {}

void BagMessages::read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content) {
  const ChunkRecords& records = this->records(entry.chunk);
  const std::string_view bytes = records.data(head(records, entry));
  content.assign(bytes.begin(), bytes.end());
}

core::Attributes BagMessages::attributes(const BagIndexEntry& entry, AttributeReader& reader) {
  const ChunkRecords& records = this->records(entry.chunk);
  const PiecesOfFile::Head message = head(records, entry);
  const std::uint64_t size = message.end - message.data;
  const auto bytes = [&](std::uint64_t from, std::uint64_t to) {
    if (size <= kAtOnce) {  // a message that is not much longer is read at once
      return records.data(message, kAhead).substr(from, to - from);
    }
    PiecesOfFile::Head piece = message;
    piece.data = message.data + from;
    piece.end = message.data + to;
    return records.data(piece);
  };
  return reader.read(size, std::ref(bytes), entry.stamp);
}

const ChunkRecords& BagMessages::records(std::uint64_t position) {
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

void BagMessages::makeRoom(std::uint64_t unpacked) {
  while (!chunks_.empty() &&
         (unpacked_ + unpacked > kMostUnpacked || chunks_.size() >= kMostChunks)) {
    unpacked_ -= chunks_.back().unpacked;
    chunks_.pop_back();
  }
}

PiecesOfFile::Head BagMessages::head(const ChunkRecords& records,
                                     const BagIndexEntry& entry) const {
  const PiecesOfFile::Head found = records.message(entry.offset);
  const MessageHeader message = messageHeader(found.header);
  if (message.stamp != entry.stamp || message.connection != numbers_.at(entry.connection)) {
    throw FormatError("its index and its messages contradict each other");
  }
  return found;
}

}  // namespace self_awareness::ros1
