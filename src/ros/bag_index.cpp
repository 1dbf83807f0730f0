#include "bag_index.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "bag_records.h"

namespace self_awareness::ros1 {
namespace {

using namespace bag_records;  // NOLINT: the format's words, in this file only

// Enough for the header of a chunk or of a message.
constexpr std::uint64_t kHeaderBytes = 256;
// Of a record of the index as every writer writes it, and of each message in it.
constexpr std::uint64_t kIndexHeaderBytes = 55;
constexpr std::uint64_t kIndexEntryBytes = 12;

/// A file that is read in pieces. The buffer of a stream would read much more than is wanted.
class PiecesOfFile {
 public:
  explicit PiecesOfFile(const std::string& path) {
    file_.rdbuf()->pubsetbuf(nullptr, 0);
    file_.open(path, std::ios::binary | std::ios::ate);
    size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(file_.tellg(), 0));
  }

  std::uint64_t size() const { return size_; }

  /// What is at a position, up to the end of the file; valid until the next call. Where it must be
  /// read, `ahead` more bytes are.
  std::string_view at(std::uint64_t position, std::uint64_t bytes, std::uint64_t ahead = 0) {
    if (position > size_) {
      throw FormatError("a position beyond the end");
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

 private:
  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::string buffer_;
  std::uint64_t position_ = 0;  // of the buffer
};

struct Chunk {
  std::uint64_t position = 0;
  std::uint64_t connections = 0;  // with messages in it
  std::uint64_t messages = 0;
};

bool earlier(const BagIndexEntry& a, const BagIndexEntry& b) {
  return std::tie(a.stamp, a.chunk, a.offset) < std::tie(b.stamp, b.chunk, b.offset);
}

/// Where the data of a chunk begins and ends in the file.
struct ChunkData {
  ChunkData(PiecesOfFile& file, std::uint64_t position) {
    std::string_view bytes = file.at(position, kHeaderBytes);
    const std::size_t before = bytes.size();
    const std::string_view header = takeHeader(bytes, Op::kChunk);
    compressed = field(header, "compression") != "none";
    const auto size = takeNumber<std::uint32_t>(bytes);
    begin = position + (before - bytes.size());
    end = begin + size;
  }

  std::uint64_t begin;
  std::uint64_t end;
  bool compressed;
};

class IndexReader {
 public:
  explicit IndexReader(const std::string& path) : file_(path) {}

  BagIndex read() {
    std::string_view start = file_.at(0, kFormat.size() + kHeaderBytes);
    if (take(start, kFormat.size()) != kFormat) {
      throw FormatError("not format 2.0");
    }
    const std::string_view header = takeHeader(start, Op::kFileHeader);
    const auto index = number<std::uint64_t>(header, "index_pos");
    const auto connections = number<std::uint32_t>(header, "conn_count");
    const auto chunks = number<std::uint32_t>(header, "chunk_count");
    if (index == 0) {
      throw FormatError("no index");
    }
    std::string_view rest = file_.at(index, file_.size());
    for (std::uint32_t i = 0; i < connections; ++i) {
      takeConnection(rest);
    }
    for (std::uint32_t i = 0; i < chunks; ++i) {
      takeChunkInfo(rest);
    }
    readEntries();
    return std::move(index_);
  }

 private:
  void takeConnection(std::string_view& bytes) {
    const std::string_view record = takeHeader(bytes, Op::kConnection);
    std::string_view fields = takeBlock(bytes);
    ros::M_string header;
    while (!fields.empty()) {
      const auto [name, value] = takeField(fields);
      header.emplace(name, value);
    }
    if (ids_.emplace(number<std::uint32_t>(record, "conn"), ids_.size()).second) {
      index_.connections.push_back(connectionFrom(header, std::string(field(record, "topic"))));
    }
  }

  void takeChunkInfo(std::string_view& bytes) {
    const std::string_view header = takeHeader(bytes, Op::kChunkInfo);
    if (number<std::uint32_t>(header, "ver") != 1) {
      throw FormatError("another version of chunk info");
    }
    Chunk chunk;
    chunk.position = number<std::uint64_t>(header, "chunk_pos");
    for (std::string_view counts = takeBlock(bytes); !counts.empty(); ++chunk.connections) {
      takeNumber<std::uint32_t>(counts);  // the connection
      chunk.messages += takeNumber<std::uint32_t>(counts);
    }
    messages_ += chunk.messages;
    chunks_.push_back(chunk);
  }

  void readEntries() {
    if (messages_ > file_.size() / kIndexEntryBytes) {
      throw FormatError("more messages than fit into the file");
    }
    index_.entries.reserve(messages_);
    for (const Chunk& chunk : chunks_) {
      const std::size_t first = index_.entries.size();
      const std::uint64_t position = ChunkData(file_, chunk.position).end;
      // The header of the next chunk follows, and is read with it.
      std::string_view bytes = file_.at(
          position, chunk.connections * kIndexHeaderBytes + chunk.messages * kIndexEntryBytes,
          kHeaderBytes);
      for (std::uint64_t i = 0; i < chunk.connections; ++i) {
        takeIndex(bytes, chunk.position);
      }
      if (index_.entries.size() - first != chunk.messages) {
        throw FormatError("chunk and index disagree");
      }
      // Recordings are nearly in order; so the whole need not be sorted.
      std::sort(index_.entries.begin() + static_cast<std::ptrdiff_t>(first), index_.entries.end(),
                earlier);
    }
    if (!std::is_sorted(index_.entries.begin(), index_.entries.end(), earlier)) {
      std::sort(index_.entries.begin(), index_.entries.end(), earlier);
    }
  }

  void takeIndex(std::string_view& bytes, std::uint64_t chunk) {
    const std::string_view header = takeHeader(bytes, Op::kIndex);
    if (number<std::uint32_t>(header, "ver") != 1) {
      throw FormatError("another version of the index");
    }
    const auto connection = ids_.find(number<std::uint32_t>(header, "conn"));
    if (connection == ids_.end()) {
      throw FormatError("messages without a connection");
    }
    BagIndexEntry entry;
    entry.chunk = chunk;
    entry.connection = connection->second;
    for (std::string_view entries = takeBlock(bytes); !entries.empty();) {
      const std::int64_t seconds = takeNumber<std::uint32_t>(entries);
      const std::int64_t nanoseconds = takeNumber<std::uint32_t>(entries);
      entry.stamp = seconds * core::kNanosecondsPerSecond + nanoseconds;
      if (entry.stamp == 0) {
        throw FormatError("a message without a time");
      }
      entry.offset = takeNumber<std::uint32_t>(entries);
      index_.entries.push_back(entry);
    }
  }

  PiecesOfFile file_;
  std::unordered_map<std::uint32_t, std::uint32_t> ids_;  // index by the connection's number
  std::vector<Chunk> chunks_;
  std::uint64_t messages_ = 0;
  BagIndex index_;
};

/// What rosbag knows of a bag.
class RosbagIndex : private rosbag::View {
 public:
  explicit RosbagIndex(const rosbag::Bag& bag) : rosbag::View(bag), bag_(bag) { update(); }

  BagIndex read() const {
    BagIndex index;
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
    std::sort(index.entries.begin(), index.entries.end(), earlier);
    return index;
  }

  void readMessage(const BagIndexEntry& entry, std::vector<std::uint8_t>& content) {
    rosbag::IndexEntry place;
    place.time.fromNSec(static_cast<std::uint64_t>(entry.stamp));
    place.chunk_pos = entry.chunk;
    place.offset = entry.offset;
    // The content is found by its place alone.
    const std::unique_ptr<rosbag::MessageInstance> message(
        newMessageInstance(nullptr, place, bag_));
    content.resize(message->size());
    ros::serialization::OStream stream(content.data(), static_cast<std::uint32_t>(content.size()));
    message->write(stream);
  }

 private:
  const rosbag::Bag& bag_;
};

}  // namespace

BagIndex readBagIndex(const std::string& path) {
  try {
    return IndexReader(path).read();
  } catch (const FormatError&) {
    // rosbag reads it all the same, or says what is wrong with it.
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    return RosbagIndex(bag).read();
  }
}

/// Messages of chunks that are not compressed.
class BagMessages::Plain {
 public:
  explicit Plain(const std::string& path) : file_(path) {}

  /// @return whether it could be read
  bool read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content) {
    try {
      if (!chunk_ || chunk_position_ != entry.chunk) {
        chunk_.emplace(file_, entry.chunk);
        chunk_position_ = entry.chunk;
      }
      if (chunk_->compressed) {
        return false;
      }
      const std::uint64_t position = chunk_->begin + entry.offset;
      std::string_view bytes = file_.at(position, kHeaderBytes, kAhead);
      const std::size_t before = bytes.size();
      takeHeader(bytes, Op::kMessage);
      const auto size = takeNumber<std::uint32_t>(bytes);
      bytes = file_.at(position + (before - bytes.size()), size);
      const std::string_view data = take(bytes, size);
      content.assign(data.begin(), data.end());
      return true;
    } catch (const FormatError&) {
      return false;
    }
  }

 private:
  static constexpr std::uint64_t kAhead = 1024;  // most messages with a type field are short

  PiecesOfFile file_;
  std::optional<ChunkData> chunk_;
  std::uint64_t chunk_position_ = 0;
};

/// Messages that only rosbag can read.
class BagMessages::Rosbag {
 public:
  explicit Rosbag(const std::string& path) : bag_(path, rosbag::bagmode::Read), index_(bag_) {}

  void read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content) {
    index_.readMessage(entry, content);
  }

 private:
  rosbag::Bag bag_;
  RosbagIndex index_;
};

BagMessages::BagMessages(const std::string& path)
    : path_(path), plain_(std::make_unique<Plain>(path)) {}

BagMessages::~BagMessages() = default;

void BagMessages::read(const BagIndexEntry& entry, std::vector<std::uint8_t>& content) {
  if (plain_->read(entry, content)) {
    return;
  }
  if (!rosbag_) {
    rosbag_ = std::make_unique<Rosbag>(path_);
  }
  rosbag_->read(entry, content);
}

}  // namespace self_awareness::ros1
