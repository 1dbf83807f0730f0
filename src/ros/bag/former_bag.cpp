#include "former_bag.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../text.h"
#include "bag_records.h"

namespace self_awareness::ros1 {
namespace {

using namespace bag_records;  // NOLINT: the format's words, in this file only

/// What rosbag knows of a bag.
class RosbagIndex : private rosbag::View {
 public:
  explicit RosbagIndex(const rosbag::Bag& bag) : rosbag::View(bag) { update(); }

  BagIndex read() const {
    BagIndex index;
    index.by_rosbag = true;
    for (const rosbag::MessageRange* range : ranges_) {
      const rosbag::ConnectionInfo& connection = *range->connection_info;
      if (!connection.header) {
        throw FormatError("messages without a connection");
      }
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

/// Checks a bag of format 1.2 before rosbag reads it, which believes what the file says: its
/// records must fill the file, their headers must be whole, and its index must point at records.
class FormerBagCheck {
 public:
  explicit FormerBagCheck(const std::string& path) : file_(path) {
    if (file_.at(0, kFormerFormat.size()) != kFormerFormat) {
      throw FormatError("another format");
    }
    std::optional<std::uint64_t> index;
    for (std::uint64_t position = kFormerFormat.size(); position < file_.size();) {
      const PiecesOfFile::Head head = file_.head(position);
      if (head.end > file_.size() || head.end - head.data > kLargestChunk) {
        throw FormatError("a record is cut off");
      }
      for (std::string_view fields = head.header; !fields.empty();) {
        takeField(fields);
      }
      records_.push_back(position);
      const Op op = bag_records::opOf(head.header);
      if (op == kDefinition) {
        checkType(head.header);
      }
      if (op == Op::kFileHeader) {
        index = number<std::uint64_t>(head.header, "index_pos");
      } else if (op == Op::kIndex) {
        indexes_.push_back({head.data, head.end, number<std::uint32_t>(head.header, "count")});
      }
      position = head.end;
    }
    if (index.value_or(0) > 0) {  // else rosbag says that there is none
      checkPosition(*index);
    }
    for (const Index& each : indexes_) {
      checkIndex(each);
    }
  }

 private:
  static constexpr std::string_view kFormerFormat = "#ROSBAG V1.2\n";
  static constexpr std::uint64_t kEntryBytes = 16;  // a time, and a position
  static constexpr std::uint64_t kReadAhead = 1 << 16;
  static constexpr Op kDefinition{0x01};             // of a topic's messages
  static constexpr std::size_t kLongestQuote = 100;  // of a name in an error [bytes]

  struct Index {
    std::uint64_t data = 0;
    std::uint64_t end = 0;
    std::uint64_t messages = 0;
  };

  /// The type of a topic stays the same.
  void checkType(std::string_view header) {
    const std::string topic(field(header, "topic"));
    const std::string type(field(header, "type"));
    const auto known = types_.emplace(topic, type).first;
    if (known->second != type) {
      throw FormatError("the topic '" + printable(topic, kLongestQuote) +
                        "' is there twice, with '" + printable(known->second, kLongestQuote) +
                        "' and with '" + printable(type, kLongestQuote) + "'");
    }
  }

  void checkIndex(const Index& index) {
    if (index.end - index.data != index.messages * kEntryBytes) {
      throw FormatError("its index contradicts itself");
    }
    for (std::uint64_t position = index.data; position < index.end; position += kEntryBytes) {
      std::string_view entry = file_.at(position, kEntryBytes, kReadAhead);
      takeTime(entry);
      checkPosition(takeNumber<std::uint64_t>(entry));
    }
  }

  void checkPosition(std::uint64_t position) const {
    if (!std::binary_search(records_.begin(), records_.end(), position)) {
      throw FormatError("its index points at no record");
    }
  }

  PiecesOfFile file_;
  std::vector<std::uint64_t> records_;  // positions, in order
  std::vector<Index> indexes_;
  std::map<std::string, std::string> types_;  // by topic
};

}  // namespace

BagIndex readFormerBag(const std::string& path) {
  const FormerBagCheck passed(path);
  const rosbag::Bag bag(path, rosbag::bagmode::Read);
  return RosbagIndex(bag).read();
}

}  // namespace self_awareness::ros1
