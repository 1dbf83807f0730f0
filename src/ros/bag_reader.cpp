#include "self_awareness/ros/bag_reader.h"

#include <rosbag/exceptions.h>
#include <rosbag/view.h>

#include <boost/filesystem/operations.hpp>
#include <cmath>
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

void openBag(rosbag::Bag& bag, const std::string& path) {
  if (!boost::filesystem::exists(path)) {
    throw BagError(path + ": no such file");
  }
  if (!boost::filesystem::is_regular_file(path)) {
    throw BagError(path + ": not a file; name a bag");
  }
  try {
    bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw BagError(path + ": the bag has no index, its recording was not ended properly" +
                   reindexHint(path));
  } catch (const rosbag::BagFormatException& error) {
    throw BagError(path + ": not a bag, or a damaged one (" + error.what() + ")" +
                   reindexHint(path));
  } catch (const rosbag::BagException& error) {
    throw BagError(path + ": truncated, damaged, or not a bag (" + error.what() + ")" +
                   reindexHint(path));
  }
}

std::string headerField(const ros::M_string& header, const std::string& name) {
  const auto field = header.find(name);
  return field == header.end() ? "" : field->second;
}

Connection connectionOf(const rosbag::MessageInstance& message) {
  const boost::shared_ptr<ros::M_string> header = message.getConnectionHeader();
  Connection connection;
  connection.callerid = headerField(*header, "callerid");
  connection.topic = message.getTopic();
  connection.datatype = message.getDataType();
  connection.definition = message.getMessageDefinition();
  connection.latching = headerField(*header, "latching") == "1";
  return connection;
}

core::EventId encode(const rosbag::MessageInstance& message, ConnectionEncoder& encoder,
                     std::vector<std::uint8_t>& buffer) {
  if (!encoder.needsContent()) {
    return encoder.id();
  }
  buffer.resize(message.size());
  ros::serialization::OStream stream(buffer.data(), static_cast<std::uint32_t>(buffer.size()));
  message.write(stream);
  return encoder.id(buffer.data(), buffer.size());
}

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
  rosbag::View view(bag_);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    summary_.has_sources |= !headerField(*connection->header, "callerid").empty();
  }
  for (const rosbag::MessageInstance& message : view) {
    const auto stamp = static_cast<std::int64_t>(message.getTime().toNSec());
    if (summary_.messages == 0) {
      summary_.start = stamp;
    }
    summary_.end = stamp;
    ++summary_.messages;
    fingerprint.add(static_cast<std::uint64_t>(stamp));
    fingerprint.add(message.getTopic());
  }
  summary_.fingerprint = fingerprint.value();
}

void BagReader::read(const Encoder& encoder, const TimeRange& range, const Handler& handler,
                     const Progress& progress) const {
  range.validate();
  const std::int64_t from = summary_.start + fromSeconds(range.start.value_or(0));
  const std::int64_t to = range.end ? summary_.start + fromSeconds(*range.end) : summary_.end;
  if (from > summary_.end) {
    throw BagError(summary_.path + ": the time range begins after the recording's end (" +
                   std::to_string(core::toSeconds(summary_.end - summary_.start)) + " s)");
  }

  // One connection of the bag is one header object, shared by all its messages.
  std::unordered_map<const ros::M_string*, std::optional<ConnectionEncoder>> connections;
  std::vector<std::uint8_t> buffer;
  std::uint64_t done = 0;
  try {
    rosbag::View view(bag_);
    for (const rosbag::MessageInstance& message : view) {
      if (progress && done % kMessagesPerProgress == 0) {
        progress(done, summary_.messages);
      }
      ++done;
      const ros::M_string* key = message.getConnectionHeader().get();
      auto connection = connections.find(key);
      if (connection == connections.end()) {
        connection = connections.emplace(key, encoder.connect(connectionOf(message))).first;
      }
      if (!connection->second || !connection->second->accept()) {
        continue;
      }
      const auto stamp = static_cast<std::int64_t>(message.getTime().toNSec());
      if (from <= stamp && stamp <= to) {
        handler({stamp, encode(message, *connection->second, buffer)});
      }
    }
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
