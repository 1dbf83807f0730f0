#include "self_awareness/ros/bag_reader.h"

#include <rosbag/exceptions.h>
#include <rosbag/view.h>

#include <algorithm>
#include <boost/filesystem/operations.hpp>
#include <cmath>
#include <fstream>
#include <memory>
#include <queue>
#include <set>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace self_awareness::ros1 {
namespace {

constexpr std::uint64_t kMessagesPerProgress = 10000;

// FNV-1a, 64 bit: names the recording, guards nothing.
class Fingerprint {
 public:
  void add(std::uint64_t value) {
    for (int byte = 0; byte < 8; ++byte) {
      hash_ = (hash_ ^ (value >> (8 * byte) & 0xff)) * 0x100000001b3;
    }
  }
  void add(const std::string& text) {
    for (const char c : text) {
      hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    }
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

std::string reindexHint(const std::string& path) {
  return "; mend it with: rosbag reindex '" + path + "'";
}

bool startsLikeABag(const std::string& path) {
  constexpr char kMagic[] = "#ROSBAG V";
  char start[sizeof kMagic] = {};
  std::ifstream(path, std::ios::binary).read(start, sizeof start - 1);
  return std::string(start) == kMagic;
}

void openBag(rosbag::Bag& bag, const std::string& path) {
  if (!boost::filesystem::exists(path)) {
    throw BagError(path + ": no such file");
  }
  if (!boost::filesystem::is_regular_file(path)) {
    throw BagError(path + ": not a file; name a bag");
  }
  if (!startsLikeABag(path)) {
    throw BagError(path + ": not a bag of ROS 1");
  }
  try {
    bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw BagError(path + ": the bag has no index, its recording was not ended properly" +
                   reindexHint(path));
  } catch (const rosbag::BagException& error) {
    throw BagError(path + ": the bag is truncated or damaged (" + error.what() + ")" +
                   reindexHint(path));
  }
}

/// The index of a bag. rosbag's own iteration leaves the order of messages with the same stamp
/// open; here it is that of the recording, as the method wants it.
class BagIndex : private rosbag::View {
 public:
  explicit BagIndex(const rosbag::Bag& bag) : rosbag::View(bag), bag_(bag) {
    update();
    for (const rosbag::MessageRange* range : ranges_) {
      cursors_.push_back({range->begin, range->end, range->connection_info});
    }
  }

  using rosbag::View::getConnections;

  /// Calls visit(connection, entry) for every message.
  template <typename Visit>
  void forEach(Visit visit) const {
    std::priority_queue<Cursor, std::vector<Cursor>, Later> next(Later(), cursors_);
    while (!next.empty()) {
      Cursor cursor = next.top();
      next.pop();
      visit(*cursor.connection, *cursor.entry);
      if (++cursor.entry != cursor.end) {
        next.push(cursor);
      }
    }
  }

  /// Reads a message's content.
  void read(const rosbag::ConnectionInfo& connection, const rosbag::IndexEntry& entry,
            std::vector<std::uint8_t>& buffer) {
    const std::unique_ptr<rosbag::MessageInstance> message(
        newMessageInstance(&connection, entry, bag_));
    buffer.resize(message->size());
    ros::serialization::OStream stream(buffer.data(), static_cast<std::uint32_t>(buffer.size()));
    message->write(stream);
  }

 private:
  struct Cursor {
    std::multiset<rosbag::IndexEntry>::const_iterator entry;
    std::multiset<rosbag::IndexEntry>::const_iterator end;
    const rosbag::ConnectionInfo* connection;
  };
  struct Later {
    bool operator()(const Cursor& a, const Cursor& b) const {
      return std::tie(a.entry->time, a.entry->chunk_pos, a.entry->offset) >
             std::tie(b.entry->time, b.entry->chunk_pos, b.entry->offset);
    }
  };

  const rosbag::Bag& bag_;
  std::vector<Cursor> cursors_;
};

std::int64_t fromSeconds(double seconds) {
  return std::llround(seconds * 1e9);
}

}  // namespace

void TimeRange::validate() const {
  if ((start && !(*start >= 0)) || (end && !(*end > start.value_or(0)))) {
    throw std::invalid_argument(
        "a time range must have 0 <= start < end, in seconds from the recording's start");
  }
}

BagReader::BagReader(const std::string& path) {
  summary_.path = path;
  openBag(bag_, path);
  try {
    summarise();
  } catch (const rosbag::BagException& error) {
    throw BagError(path + ": the index is damaged (" + error.what() + ")" + reindexHint(path));
  }
  if (summary_.messages == 0) {
    throw BagError(path + ": the bag holds no messages");
  }
}

void BagReader::summarise() {
  Fingerprint fingerprint;
  BagIndex index(bag_);
  index.forEach([&](const rosbag::ConnectionInfo& connection, const rosbag::IndexEntry& entry) {
    const auto stamp = static_cast<std::int64_t>(entry.time.toNSec());
    if (summary_.messages == 0) {
      summary_.start = stamp;
    }
    summary_.end = stamp;
    ++summary_.messages;
    fingerprint.add(static_cast<std::uint64_t>(stamp));
    fingerprint.add(connection.topic);
  });
  summary_.fingerprint = fingerprint.value();
  const std::vector<const rosbag::ConnectionInfo*> connections = index.getConnections();
  summary_.has_sources = std::any_of(
      connections.begin(), connections.end(), [](const rosbag::ConnectionInfo* connection) {
        return !connectionFrom(*connection->header, connection->topic).callerid.empty();
      });
}

std::pair<std::int64_t, std::int64_t> BagReader::limits(const TimeRange& range) const {
  range.validate();
  return {
      summary_.start + fromSeconds(range.start.value_or(0)),
      range.end ? std::min(summary_.start + fromSeconds(*range.end), summary_.end) : summary_.end};
}

void BagReader::read(const Encoder& encoder, const TimeRange& range, const Handler& handler,
                     const Progress& progress) const {
  const auto limits_of_range = limits(range);  // no structured binding: a lambda captures them
  const std::int64_t from = limits_of_range.first;
  const std::int64_t to = limits_of_range.second;
  if (from > summary_.end) {
    throw BagError(summary_.path + ": the time range begins after the recording's end (" +
                   std::to_string(core::toSeconds(summary_.end - summary_.start)) + " s)");
  }

  std::unordered_map<const rosbag::ConnectionInfo*, std::optional<ConnectionEncoder>> encoders;
  std::vector<std::uint8_t> buffer;
  std::uint64_t done = 0;
  BagIndex index(bag_);
  const auto visit = [&](const rosbag::ConnectionInfo& connection,
                         const rosbag::IndexEntry& entry) {
    if (progress && done % kMessagesPerProgress == 0) {
      progress(done, summary_.messages);
    }
    ++done;
    auto found = encoders.find(&connection);
    if (found == encoders.end()) {
      found = encoders
                  .emplace(&connection,
                           encoder.connect(connectionFrom(*connection.header, connection.topic)))
                  .first;
    }
    std::optional<ConnectionEncoder>& connection_encoder = found->second;
    if (!connection_encoder || !connection_encoder->accept()) {
      return;
    }
    const auto stamp = static_cast<std::int64_t>(entry.time.toNSec());
    if (stamp < from || stamp > to) {
      return;
    }
    if (connection_encoder->needsContent()) {
      index.read(connection, entry, buffer);
      handler({stamp, connection_encoder->id(buffer.data(), buffer.size())});
    } else {
      handler({stamp, connection_encoder->id()});
    }
  };
  try {
    index.forEach(visit);
  } catch (const rosbag::BagException& error) {
    throw BagError(summary_.path + ": a message cannot be read (" + error.what() + ")" +
                   reindexHint(summary_.path));
  } catch (const std::out_of_range& error) {
    throw BagError(summary_.path + ": " + error.what());
  }
  if (progress) {
    progress(done, summary_.messages);
  }
}

}  // namespace self_awareness::ros1
