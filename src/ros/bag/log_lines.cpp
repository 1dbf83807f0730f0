#include "log_lines.h"

#include <rosbag/exceptions.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../message_cursor.h"
#include "../text.h"
#include "bag_messages.h"
#include "open_bag.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/stable_name.h"

namespace self_awareness::ros1 {
namespace {

/// Of rosgraph_msgs/Log, whose layout NamedLine knows.
constexpr char kMd5OfLog[] = "acffd30cd6b6de30f120938c17c593fb";

struct NamedLine {
  std::string node;
  LogLine line;
};

/// None: the message is shorter than it says.
std::optional<NamedLine> parse(std::int64_t stamp, const std::vector<std::uint8_t>& content) {
  try {
    MessageCursor cursor(content.data(), content.size());
    for (int i = 0; i < 3; ++i) {
      cursor.number<std::uint32_t>();  // sequence number and stamp of the header
    }
    cursor.string();  // frame
    NamedLine named;
    named.line.stamp = stamp;
    named.line.level = cursor.number<std::uint8_t>();
    named.node = stableName(std::string(cursor.string().substr(0, kLongestName)));
    std::string text(cursor.string().substr(0, kLongestLine));
    std::replace(text.begin(), text.end(), '\n', ' ');
    named.line.text = printable(text);
    return named;
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

/// Where the lines are, in the order of the recording. /rosout_agg repeats /rosout.
std::vector<BagIndexEntry> linesIn(const BagIndex& index) {
  for (const char* topic : {"/rosout", "/rosout_agg"}) {
    std::vector<BagIndexEntry> lines;
    std::copy_if(index.entries.begin(), index.entries.end(), std::back_inserter(lines),
                 [&](const BagIndexEntry& entry) {
                   const Connection& connection = index.connections[entry.connection];
                   return connection.topic == topic && connection.md5sum == kMd5OfLog;
                 });
    if (!lines.empty()) {
      return lines;
    }
  }
  return {};
}

std::vector<LogLine> lastLines(const LogQuery& query, const std::vector<BagIndexEntry>& places,
                               BagMessages& messages, std::size_t most) {
  const auto after = std::upper_bound(
      places.begin(), places.end(), query.until,
      [](std::int64_t until, const BagIndexEntry& entry) { return until < entry.stamp; });
  std::vector<LogLine> lines;
  std::vector<std::uint8_t> content;
  std::size_t read = 0;
  for (auto place = after; place != places.begin() && lines.size() < most && read < kMostLinesRead;
       ++read) {
    --place;
    messages.read(*place, content);
    std::optional<NamedLine> named = parse(place->stamp, content);
    if (named && named->node == query.node) {
      lines.push_back(std::move(named->line));
    }
  }
  std::reverse(lines.begin(), lines.end());
  return lines;
}

}  // namespace

std::vector<std::vector<LogLine>> lastLogLines(const std::string& path,
                                               const std::vector<LogQuery>& queries,
                                               std::size_t most) {
  const BagIndex index = openBag(path);
  const std::vector<BagIndexEntry> places = linesIn(index);
  std::vector<std::vector<LogLine>> found;
  try {
    const std::unique_ptr<BagMessages> messages = BagMessages::open(path, index);
    for (const LogQuery& query : queries) {
      found.push_back(lastLines(query, places, *messages, most));
    }
  } catch (const rosbag::BagException& error) {
    throw BagError(path + ": a message cannot be read (" + error.what() + ")" + reindexHint(path));
  } catch (const std::bad_alloc&) {
    throw BagError(path + ": the bag is damaged, or there is too little memory" +
                   reindexHint(path));
  }
  return found;
}

}  // namespace self_awareness::ros1
