#include "log_lines.h"

#include <rosbag/exceptions.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../log_line.h"
#include "bag_messages.h"
#include "open_bag.h"
#include "self_awareness/ros/bag/bag_reader.h"

namespace self_awareness::ros1 {
namespace {

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
                               const Encoder& encoder, BagMessages& messages, std::size_t most) {
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
    std::optional<SaidLine> said = readLogLine(content.data(), content.size());
    if (said && encoder.sourceOf(said->node) == query.node) {
      lines.push_back({place->stamp, said->level, std::move(said->text)});
    }
  }
  std::reverse(lines.begin(), lines.end());
  return lines;
}

std::vector<std::vector<LogLine>> lastLinesOfFile(const std::string& path, const Encoder& encoder,
                                                  const std::vector<LogQuery>& queries,
                                                  std::size_t most) {
  const BagIndex index = openBag(path);
  const std::vector<BagIndexEntry> places = linesIn(index);
  std::vector<std::vector<LogLine>> found;
  try {
    BagMessages messages(path, index.numbers);
    for (const LogQuery& query : queries) {
      found.push_back(lastLines(query, places, encoder, messages, most));
    }
  } catch (const rosbag::BagException& error) {
    throw BagError(path + ": a message cannot be read (" + error.what() + ")" + reindexHint(path));
  } catch (const std::bad_alloc&) {
    throw BagError(path + ": the bag is damaged, or there is too little memory" +
                   reindexHint(path));
  }
  return found;
}

}  // namespace

std::vector<std::vector<LogLine>> lastLogLines(const std::vector<std::string>& paths,
                                               const Encoder& encoder,
                                               const std::vector<LogQuery>& queries,
                                               std::size_t most) {
  std::vector<std::vector<LogLine>> found(queries.size());
  for (const std::string& path : paths) {
    std::vector<std::vector<LogLine>> of_file = lastLinesOfFile(path, encoder, queries, most);
    for (std::size_t k = 0; k < queries.size(); ++k) {
      std::move(of_file[k].begin(), of_file[k].end(), std::back_inserter(found[k]));
      const std::size_t excess = found[k].size() - std::min(found[k].size(), most);
      found[k].erase(found[k].begin(), found[k].begin() + static_cast<std::ptrdiff_t>(excess));
    }
  }
  return found;
}

}  // namespace self_awareness::ros1
