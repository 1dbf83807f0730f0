#include "bag_index.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "bag_records.h"

namespace self_awareness::ros1 {
namespace {

using namespace bag_records;  // NOLINT: the format's words, in this file only

constexpr std::uint64_t kFileHeaderBytes = 4096;  // every writer fills it up to this
// Header of a record of the index, as every writer writes it.
constexpr std::uint64_t kIndexHeaderBytes = 55;
// Each message in such a record.
constexpr std::uint64_t kIndexEntryBytes = 12;

struct ChunkInfo {
  std::uint64_t position = 0;
  std::uint64_t connections = 0;  // with messages in it
  std::uint64_t messages = 0;
};

// A type and not a function, so that std::sort can inline it: sorting takes most of the time here.
struct Earlier {
  bool operator()(const BagIndexEntry& a, const BagIndexEntry& b) const {
    if (a.stamp != b.stamp) {
      return a.stamp < b.stamp;
    }
    return std::tie(a.chunk, a.offset) < std::tie(b.chunk, b.offset);
  }
};

class IndexReader {
 public:
  explicit IndexReader(const std::string& path) : file_(path) {}

  /// None if the bag is of another format or encrypted.
  std::optional<BagIndex> read() {
    if (!readConnections()) {
      return std::nullopt;
    }
    readEntries();
    return std::move(index_);
  }

  std::vector<Connection> connections() {
    readConnections();
    return std::move(index_.connections);
  }

 private:
  /// Reads the records at the end of the bag; false if it is of another format or encrypted.
  bool readConnections() {
    std::string_view start = file_.at(0, kFileHeaderBytes);
    if (start.substr(0, kFormat.size()) != kFormat) {
      return false;
    }
    take(start, kFormat.size());
    const std::string_view header = takeHeader(start, Op::kFileHeader);
    if (isEncrypted(header)) {
      return false;
    }
    const auto index = number<std::uint64_t>(header, "index_pos");
    const auto connections = number<std::uint32_t>(header, "conn_count");
    const auto chunks = number<std::uint32_t>(header, "chunk_count");
    if (index == 0) {
      throw rosbag::BagUnindexedException();
    }
    std::string_view rest = file_.at(index, file_.size());
    for (std::uint32_t i = 0; i < connections; ++i) {
      takeConnection(rest);
    }
    for (std::uint32_t i = 0; i < chunks; ++i) {
      takeChunkInfo(rest);
    }
    return true;
  }

  static bool isEncrypted(std::string_view header) {
    while (!header.empty()) {
      const auto [name, value] = takeField(header);
      if (name == "encryptor" && !value.empty()) {
        return true;
      }
    }
    return false;
  }

  void takeConnection(std::string_view& bytes) {
    const std::string_view record = takeHeader(bytes, Op::kConnection);
    std::string_view fields = takeBlock(bytes);
    ros::M_string header;
    bool in_order = true;
    while (!fields.empty()) {
      const auto [name, value] = takeField(fields);
      in_order &= header.empty() || header.rbegin()->first < name;
      header.emplace(name, value);
    }
    index_.recorded |= in_order && header.count("latching") > 0;
    if (ids_.emplace(number<std::uint32_t>(record, "conn"), ids_.size()).second) {
      index_.connections.push_back(connectionFrom(header, std::string(field(record, "topic"))));
    }
  }

  void takeChunkInfo(std::string_view& bytes) {
    const std::string_view header = takeHeader(bytes, Op::kChunkInfo);
    if (number<std::uint32_t>(header, "ver") != 1) {
      throw FormatError("another version of chunk info");
    }
    ChunkInfo chunk;
    chunk.position = number<std::uint64_t>(header, "chunk_pos");
    for (std::string_view counts = takeBlock(bytes); !counts.empty(); ++chunk.connections) {
      takeNumber<std::uint32_t>(counts);  // the connection
      chunk.messages += takeNumber<std::uint32_t>(counts);
    }
    messages_ += chunk.messages;
    chunks_.push_back(chunk);
  }

  void readEntries() {
    index_.entries.reserve(std::min(messages_, file_.size() / kIndexEntryBytes));
    for (const ChunkInfo& chunk : chunks_) {
      const auto first = static_cast<std::ptrdiff_t>(index_.entries.size());
      const Chunk header(file_, chunk.position);
      index_.by_python |= header.by_python;
      std::uint64_t position = header.end;
      // Reads all records at once, with the header of the next chunk, which follows.
      file_.at(position, chunk.connections * kIndexHeaderBytes + chunk.messages * kIndexEntryBytes,
               2 * kHeaderBytes);
      for (std::uint64_t i = 0; i < chunk.connections; ++i) {
        position = readRecord(position, chunk.position);
      }
      // Recordings are nearly in order, so it is mostly enough to sort each chunk.
      std::sort(index_.entries.begin() + first, index_.entries.end(), Earlier());
    }
    if (!std::is_sorted(index_.entries.begin(), index_.entries.end(), Earlier())) {
      std::sort(index_.entries.begin(), index_.entries.end(), Earlier());
    }
  }

  /// Reads a record; returns where the next one begins.
  std::uint64_t readRecord(std::uint64_t position, std::uint64_t chunk) {
    std::string_view bytes = file_.at(position, kHeaderBytes);
    const std::size_t all = bytes.size();
    const std::string_view header = takeHeader(bytes, Op::kIndex);
    if (number<std::uint32_t>(header, "ver") != 1) {
      throw FormatError("another version of the index");
    }
    const auto connection = ids_.find(number<std::uint32_t>(header, "conn"));
    if (connection == ids_.end()) {
      throw FormatError("messages without a connection");
    }
    const auto size = takeNumber<std::uint32_t>(bytes);
    position += all - bytes.size();
    bytes = file_.at(position, size);
    BagIndexEntry entry;
    entry.chunk = chunk;
    entry.connection = connection->second;
    for (std::string_view entries = take(bytes, size); !entries.empty();) {
      const std::int64_t seconds = takeNumber<std::uint32_t>(entries);
      const std::int64_t nanoseconds = takeNumber<std::uint32_t>(entries);
      entry.stamp = seconds * core::kNanosecondsPerSecond + nanoseconds;
      entry.offset = takeNumber<std::uint32_t>(entries);
      if (entry.stamp != 0) {  // rosbag, too, leaves out messages without a time
        index_.entries.push_back(entry);
      }
    }
    return position + size;
  }

  PiecesOfFile file_;
  std::unordered_map<std::uint32_t, std::uint32_t> ids_;  // index by the connection's number
  std::vector<ChunkInfo> chunks_;
  std::uint64_t messages_ = 0;
  BagIndex index_;
};

/// What rosbag knows of a bag.
class RosbagIndex : private rosbag::View {
 public:
  explicit RosbagIndex(const rosbag::Bag& bag) : rosbag::View(bag) { update(); }

  BagIndex read() const {
    BagIndex index;
    index.by_rosbag = true;
    for (const rosbag::MessageRange* range : ranges_) {
      const rosbag::ConnectionInfo& connection = *range->connection_info;
      BagIndexEntry entry;
      entry.connection = static_cast<std::uint32_t>(index.connections.size());
      index.connections.push_back(connectionFrom(*connection.header, connection.topic));
      for (auto at = range->begin; at != range->end; ++at) {
        entry.stamp = static_cast<std::int64_t>(at->time.toNSec());
        entry.chunk = at->chunk_pos;
        entry.offset = at->offset;
        index.entries.push_back(entry);
      }
    }
    std::sort(index.entries.begin(), index.entries.end(), Earlier());
    return index;
  }
};

}  // namespace

std::vector<Connection> readBagConnections(const std::string& path) {
  return IndexReader(path).connections();
}

BagIndex readBagIndex(const std::string& path) {
  if (std::optional<BagIndex> index = IndexReader(path).read()) {
    return std::move(*index);
  }
  const rosbag::Bag bag(path, rosbag::bagmode::Read);
  return RosbagIndex(bag).read();
}

}  // namespace self_awareness::ros1
