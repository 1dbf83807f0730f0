#include "bag_index.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "bag_records.h"

namespace self_awareness::ros1 {
namespace {

using namespace bag_records;  // NOLINT: the format's words, in this file only

constexpr std::uint64_t kFileHeaderBytes = 4096;  // every writer fills it up to this
constexpr std::uint64_t kIndexEntryBytes = 12;    // of a message in a record of the index
// Entries that are read at once.
constexpr std::uint64_t kEntriesPerPiece = 1 << 14;

struct ChunkInfo {
  std::uint64_t position = 0;
  std::map<std::uint32_t, std::uint64_t> messages;  // by connection
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
    readChunks();
    return std::move(index_);
  }

  std::vector<Connection> connections() {
    readConnections();
    return std::move(index_.connections);
  }

 private:
  /// Reads the connections at the end of the bag; false if it is of another format or encrypted.
  bool readConnections() {
    if (file_.at(0, kFormat.size()) != kFormat) {
      return false;
    }
    const PiecesOfFile::Record start = file_.record(kFormat.size(), kFileHeaderBytes);
    if (opOf(start.header) != Op::kFileHeader) {
      throw FormatError("it does not begin with a header");
    }
    if (isEncrypted(start.header)) {
      return false;
    }
    index_position_ = number<std::uint64_t>(start.header, "index_pos");
    const auto connections = number<std::uint32_t>(start.header, "conn_count");
    chunks_ = number<std::uint32_t>(start.header, "chunk_count");
    position_ = start.end;
    if (index_position_ == 0) {
      throw rosbag::BagUnindexedException();
    }
    if (connections > kMostConnections) {
      throw FormatError("too many connections");
    }
    info_position_ = index_position_;
    for (std::uint32_t i = 0; i < connections; ++i) {
      const PiecesOfFile::Record record = file_.record(info_position_, kLargestConnection);
      info_position_ = record.end;
      addConnection(record);
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

  void addConnection(const PiecesOfFile::Record& record) {
    if (opOf(record.header) != Op::kConnection) {
      throw FormatError("a record of another kind");
    }
    ros::M_string header;
    bool in_order = true;
    for (std::string_view fields = record.data; !fields.empty();) {
      const auto [name, value] = takeField(fields);
      in_order &= header.empty() || header.rbegin()->first < name;
      header.emplace(name, value);
    }
    index_.recorded |= in_order && header.count("latching") > 0;
    const auto id = number<std::uint32_t>(record.header, "conn");
    if (ids_.emplace(id, ids_.size()).second) {
      index_.connections.push_back(
          connectionFrom(header, std::string(field(record.header, "topic"))));
      index_.numbers.push_back(id);
    }
  }

  ChunkInfo takeChunkInfo() {
    const PiecesOfFile::Record record =
        file_.record(info_position_, kMostConnections * 2 * sizeof(std::uint32_t));
    info_position_ = record.end;
    if (opOf(record.header) != Op::kChunkInfo ||
        number<std::uint32_t>(record.header, "ver") != 1) {
      throw FormatError("another version of chunk info");
    }
    ChunkInfo chunk;
    chunk.position = number<std::uint64_t>(record.header, "chunk_pos");
    for (std::string_view counts = record.data; !counts.empty();) {
      const auto connection = takeNumber<std::uint32_t>(counts);
      chunk.messages[connection] = takeNumber<std::uint32_t>(counts);
    }
    return chunk;
  }

  void readChunks() {
    for (std::uint32_t i = 0; i < chunks_; ++i) {
      const auto first = index_.entries.size();
      readChunk(takeChunkInfo());
      // Recordings are nearly in order, so it is mostly enough to sort each chunk.
      std::sort(index_.entries.begin() + static_cast<std::ptrdiff_t>(first), index_.entries.end(),
                Earlier());
    }
    // `rosbag reindex` leaves what it could not mend of the only chunk: no messages, no damage.
    if (chunks_ > 0) {
      passConnections(index_position_);
    }
    if (info_position_ != file_.size()) {
      throw FormatError("it goes on after its end");
    }
    if (!std::is_sorted(index_.entries.begin(), index_.entries.end(), Earlier())) {
      std::sort(index_.entries.begin(), index_.entries.end(), Earlier());
    }
  }

  /// Goes on to a position; only connections may lie before it.
  void passConnections(std::uint64_t position) {
    while (position_ < position) {
      const PiecesOfFile::Record record = file_.record(position_, kLargestConnection);
      if (opOf(record.header) != Op::kConnection) {
        throw FormatError("its index leaves out a chunk");
      }
      position_ = record.end;
    }
    if (position_ != position) {
      throw FormatError("its index has a chunk twice, or in another one");
    }
  }

  void readChunk(const ChunkInfo& info) {
    if (info.position < position_ || info.position >= index_position_) {
      throw FormatError("its index has a chunk twice, or in another one");
    }
    passConnections(info.position);
    const Chunk chunk(file_, info.position);
    index_.by_python |= chunk.by_python;
    position_ = chunk.end;
    const std::size_t first = index_.entries.size();
    for (std::size_t i = 0; i < info.messages.size(); ++i) {
      readRecord(info, chunk);
    }
    places_.clear();
    for (std::size_t i = first; i < index_.entries.size(); ++i) {
      places_.push_back({index_.entries[i].offset, i});
    }
    std::sort(places_.begin(), places_.end());
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (i > 0 && places_[i].first == places_[i - 1].first) {
        throw FormatError("its index has a message twice");
      }
      if (chunk.compression == "none") {
        checkMessage(index_.entries[places_[i].second], chunk);
      }
    }
    if (!chunks_seen_.insert(hashOf(first)).second && spansTime(first)) {
      throw FormatError("it holds the same messages twice");
    }
  }

  /// Of the entries from the given one on (FNV-1a, 64 bit, by numbers instead of bytes).
  std::uint64_t hashOf(std::size_t first) const {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (std::size_t i = first; i < index_.entries.size(); ++i) {
      const BagIndexEntry& entry = index_.entries[i];
      for (const std::uint64_t number : {static_cast<std::uint64_t>(entry.stamp),
                                         std::uint64_t{entry.offset} << 32U | entry.connection}) {
        hash = (hash ^ number) * 0x100000001b3;
        hash ^= hash >> 29U;
      }
    }
    return hash;
  }

  /// Messages of one moment may be the same in two chunks: the clock of a simulation stands still.
  bool spansTime(std::size_t first) const {
    const auto begin = index_.entries.begin() + static_cast<std::ptrdiff_t>(first);
    return std::any_of(begin, index_.entries.end(),
                       [&](const BagIndexEntry& entry) { return entry.stamp != begin->stamp; });
  }

  /// Reads the messages of one connection in a chunk.
  void readRecord(const ChunkInfo& info, const Chunk& chunk) {
    const PiecesOfFile::Head head = file_.head(position_);
    if (opOf(head.header) != Op::kIndex || number<std::uint32_t>(head.header, "ver") != 1) {
      throw FormatError("another version of the index");
    }
    const auto number_of_connection = number<std::uint32_t>(head.header, "conn");
    const auto connection = ids_.find(number_of_connection);
    if (connection == ids_.end()) {
      throw FormatError("messages without a connection");
    }
    const auto announced = info.messages.find(number_of_connection);
    const std::uint64_t size = head.end - head.data;
    if (announced == info.messages.end() || size != announced->second * kIndexEntryBytes ||
        announced->second > chunk.unpacked_bytes / kLeastMessageBytes) {
      throw FormatError("its index contradicts itself");
    }
    position_ = head.data;
    BagIndexEntry entry;
    entry.chunk = info.position;
    entry.connection = connection->second;
    for (const std::uint64_t end = position_ + size; position_ < end;) {
      const std::uint64_t piece = std::min(end - position_, kEntriesPerPiece * kIndexEntryBytes);
      std::string_view bytes = file_.at(position_, piece);
      for (std::string_view entries = take(bytes, piece); !entries.empty();) {
        entry.stamp = takeTime(entries);
        entry.offset = takeNumber<std::uint32_t>(entries);
        if (entry.offset >= chunk.unpacked_bytes) {
          throw FormatError("a message beyond the end of its chunk");
        }
        if (entry.stamp != 0) {  // rosbag, too, leaves out messages without a time
          index_.entries.push_back(entry);
        }
      }
      position_ += piece;
    }
  }

  /// Compares what the index says of a message with the message.
  void checkMessage(const BagIndexEntry& entry, const Chunk& chunk) {
    const PiecesOfFile::Head head = headOfMessage(file_, chunk.begin + entry.offset);
    const MessageHeader message = messageHeader(head.header);
    if (message.stamp != entry.stamp || message.connection != index_.numbers[entry.connection] ||
        head.end > chunk.end) {
      throw FormatError("its index and its messages contradict each other");
    }
  }

  PiecesOfFile file_;
  std::uint64_t position_ = 0;        // up to here, all that is in the file has been looked at
  std::uint64_t index_position_ = 0;  // of the connections at the end
  std::uint64_t info_position_ = 0;   // of the next chunk info
  std::uint32_t chunks_ = 0;
  std::unordered_map<std::uint32_t, std::uint32_t> ids_;       // index by the connection's number
  std::vector<std::pair<std::uint32_t, std::size_t>> places_;  // offset, and index of the entry
  std::unordered_set<std::uint64_t> chunks_seen_;              // by hashOf()
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

/// Checks that no record of a bag that is left to rosbag is longer than the file: rosbag makes
/// room for what a length says, and ends the program where there is none.
void checkRecords(const std::string& path) {
  PiecesOfFile file(path);
  for (std::uint64_t position = kFormat.size(); position < file.size();) {
    const PiecesOfFile::Head head = file.head(position);
    if (head.end > file.size() || head.end - head.data > kLargestChunk) {
      throw FormatError("a record is cut off");
    }
    position = head.end;
  }
}

}  // namespace

std::vector<Connection> readBagConnections(const std::string& path) {
  return IndexReader(path).connections();
}

std::optional<BagIndex> readIndexOfFormat2(const std::string& path) {
  return IndexReader(path).read();
}

BagIndex readBagIndex(const std::string& path) {
  if (std::optional<BagIndex> index = readIndexOfFormat2(path)) {
    return std::move(*index);
  }
  checkRecords(path);
  const rosbag::Bag bag(path, rosbag::bagmode::Read);
  return RosbagIndex(bag).read();
}

}  // namespace self_awareness::ros1
