#include "bag_index.h"

#include <rosbag/exceptions.h>

#include <algorithm>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "../content_digest.h"
#include "../text.h"
#include "bag_records.h"
#include "self_awareness/ros/stable_name.h"

namespace self_awareness::ros1 {
namespace {

using namespace bag_records;  // NOLINT: the format's words, in this file only

constexpr std::uint64_t kIndexEntryBytes = 12;  // of a message in a record of the index
// Entries that are read at once.
constexpr std::uint64_t kEntriesPerPiece = 1 << 14;

struct ChunkInfo {
  std::uint64_t position = 0;
  std::int64_t start = 0;  // stamps of its messages [ns]
  std::int64_t end = 0;
  std::map<std::uint32_t, std::uint64_t> messages;  // by connection
};

class IndexReader {
 public:
  explicit IndexReader(const std::string& path, bool unpack = false,
                       const ChunkProgress& progress = nullptr)
      : file_(path), unpack_(unpack), progress_(progress) {
    readConnections();
  }

  BagIndex read() {
    readChunks();
    return std::move(index_);
  }
  std::vector<Connection> connections() { return std::move(index_.connections); }
  BagSpan span() {
    BagSpan span;
    for (std::uint32_t i = 0; i < chunks_; ++i) {
      const ChunkInfo chunk = takeChunkInfo();
      span.start = span.messages == 0 ? chunk.start : std::min(span.start, chunk.start);
      span.end = std::max(span.end, chunk.end);
      for (const auto& [connection, messages] : chunk.messages) {
        span.messages += messages;
      }
    }
    return span;
  }

 private:
  /// Reads the connections at the end of the bag.
  void readConnections() {
    if (file_.at(0, kFormat.size()) != kFormat) {
      throw FormatError("it is no bag of format 2.0");
    }
    const PiecesOfFile::Record start = file_.record(kFormat.size(), kFileHeaderBytes);
    if (opOf(start.header) != Op::kFileHeader) {
      throw FormatError("it does not begin with a header");
    }
    if (!findField(start.header, "encryptor").value_or("").empty()) {
      throw EncryptedError();
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
    if (ids_.count(id) > 0) {
      checkConnection(id, field(record.header, "topic"), record.data);
      return;
    }
    const std::string topic(field(record.header, "topic"));
    const auto said = header.find("topic");
    if (said != header.end() && !isTheSame(topic, said->second)) {
      throw FormatError("the connection " + std::to_string(id) + " is on " + quote(topic) +
                        " by its header, and on " + quote(said->second) + " by its data");
    }
    ids_.emplace(id, ids_.size());
    index_.connections.push_back(connectionFrom(header, topic));
    index_.numbers.push_back(id);
    connections_.push_back({topic, std::string(record.data)});
  }

  /// `rosbag record` writes the name that it was given, which may be relative to a namespace, or
  /// have a slash too many; what the publisher said is the whole name.
  static bool isTheSame(const std::string& topic, const std::string& said) {
    const std::string end = resolvedName(topic);
    const std::string whole = resolvedName(said);
    const bool relative = !topic.empty() && topic[0] != '/';
    return whole == end || (relative && whole.size() >= end.size() &&
                            whole.compare(whole.size() - end.size(), end.size(), end) == 0);
  }

  /// A connection that is there again, as it is in every chunk, must be what it was.
  void checkConnection(std::uint32_t id, std::string_view topic, std::string_view data) const {
    const auto known = ids_.find(id);
    if (known == ids_.end()) {
      return;  // no message is of it
    }
    const ConnectionRecord& first = connections_[known->second];
    if (topic != first.topic) {
      throw FormatError("the connection " + std::to_string(id) + " is there twice, on " +
                        quote(first.topic) + " and on " + quote(topic));
    }
    if (data == first.data) {  // so it mostly is: to compare the fields takes much longer
      return;
    }
    ros::M_string fields;
    while (!data.empty()) {
      const auto [name, value] = takeField(data);
      fields.emplace(name, value);
    }
    const Connection again = connectionFrom(fields, std::string(topic));
    const Connection& before = index_.connections[known->second];
    if (again.datatype != before.datatype || again.md5sum != before.md5sum ||
        again.definition != before.definition || again.callerid != before.callerid) {
      throw FormatError("the connection " + std::to_string(id) + ", on " + quote(topic) +
                        ", is there twice, with " + quote(before.datatype) + " from " +
                        quote(before.callerid) + " and with " + quote(again.datatype) + " from " +
                        quote(again.callerid) +
                        (again.datatype == before.datatype ? " of another definition" : ""));
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
    chunk.start = timeIn(record.header, "start_time");
    chunk.end = timeIn(record.header, "end_time");
    for (std::string_view counts = record.data; !counts.empty();) {
      const auto connection = takeNumber<std::uint32_t>(counts);
      chunk.messages[connection] = takeNumber<std::uint32_t>(counts);
    }
    return chunk;
  }

  void readChunks() {
    for (std::uint32_t i = 0; i < chunks_; ++i) {
      const auto first = index_.entries.size();
      const ChunkInfo info = takeChunkInfo();
      try {
        readChunk(info);
      } catch (const rosbag::BagException& error) {
        throw FormatError("chunk " + std::to_string(i + 1) + " of " + std::to_string(chunks_) +
                          ", at byte " + std::to_string(info.position) + ": " + error.what());
      }
      if (progress_) {
        progress_(i + 1, chunks_);
      }
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

  /// Goes on to a position; only connections may lie before it, and what `rosbag reindex` leaves
  /// of an index that was cut off.
  void passConnections(std::uint64_t position) {
    while (position_ < position) {
      const PiecesOfFile::Record record = file_.record(position_, kLargestConnection);
      const Op op = opOf(record.header);
      if (op == Op::kConnection) {
        checkConnection(number<std::uint32_t>(record.header, "conn"),
                        field(record.header, "topic"), record.data);
      } else if (op != Op::kChunkInfo) {
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
    }
    if (unpack_ || !chunk.isPacked()) {
      checkMessages(chunk);
    }
    if (!chunks_seen_.insert(hashOf(first)).second && spansTime(first)) {
      throw FormatError("it holds the same messages twice");
    }
  }

  /// Of the entries from the given one on.
  std::uint64_t hashOf(std::size_t first) const {
    ContentDigest digest;
    for (std::size_t i = first; i < index_.entries.size(); ++i) {
      const BagIndexEntry& entry = index_.entries[i];
      digest.mix(static_cast<std::uint64_t>(entry.stamp));
      digest.mix(std::uint64_t{entry.offset} << 32U | entry.connection);
    }
    return digest.value();
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
        if (entry.stamp != 0) {
          index_.entries.push_back(entry);
        } else {
          ++index_.timeless;
        }
      }
      position_ += piece;
    }
  }

  /// Compares what the index says of the messages in a chunk, in places_, with the messages, and
  /// the connections between them with what the bag says of these.
  void checkMessages(const Chunk& chunk) {
    const ChunkRecords records(file_, chunk);
    std::uint64_t place = 0;
    for (const auto& [offset, number_of_entry] : places_) {
      place = checkMessage(index_.entries[number_of_entry], records, place);
    }
  }

  /// @param place that a record of the chunk begins at
  /// @return place after the message
  std::uint64_t checkMessage(const BagIndexEntry& entry, const ChunkRecords& records,
                             std::uint64_t place) {
    for (bool reached = false;;) {
      reached |= place == entry.offset;
      if (place > entry.offset && !reached) {
        throw FormatError("its index points into a message");
      }
      const PiecesOfFile::Head head = records.head(place);
      place = head.end;
      if (opOf(head.header) == Op::kConnection) {
        const auto id = number<std::uint32_t>(head.header, "conn");
        const std::string topic(field(head.header, "topic"));
        checkConnection(id, topic, records.data(head));
        continue;
      }
      const MessageHeader message = messageHeader(head.header);
      if (!reached) {
        continue;  // one without a time
      }
      if (message.stamp != entry.stamp || message.connection != index_.numbers[entry.connection]) {
        throw FormatError("its index and its messages contradict each other");
      }
      return place;
    }
  }

  /// Of a connection, as the bag has it at its end.
  struct ConnectionRecord {
    std::string topic;
    std::string data;
  };

  PiecesOfFile file_;
  bool unpack_;
  ChunkProgress progress_;
  std::uint64_t position_ = 0;        // up to here, all that is in the file has been looked at
  std::uint64_t index_position_ = 0;  // of the connections at the end
  std::uint64_t info_position_ = 0;   // of the next chunk info
  std::uint32_t chunks_ = 0;
  std::unordered_map<std::uint32_t, std::uint32_t> ids_;       // index by the connection's number
  std::vector<ConnectionRecord> connections_;                  // by that index
  std::vector<std::pair<std::uint32_t, std::size_t>> places_;  // offset, and index of the entry
  std::unordered_set<std::uint64_t> chunks_seen_;              // by hashOf()
  BagIndex index_;
};

}  // namespace

std::vector<Connection> readBagConnections(const std::string& path) {
  return IndexReader(path).connections();
}

BagSpan readBagSpan(const std::string& path) {
  return IndexReader(path).span();
}

BagIndex readBagIndex(const std::string& path, bool unpack, const ChunkProgress& progress) {
  return IndexReader(path, unpack, progress).read();
}

}  // namespace self_awareness::ros1
