#include "log_lines.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "../message_cursor.h"
#include "../text.h"
#include "recording_files.h"
#include "self_awareness/ros/stable_name.h"

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
                               const RecordingFiles& files, const Encoder& encoder,
                               RecordingFiles::Messages& messages, std::size_t most) {
  const auto after = std::upper_bound(
      places.begin(), places.end(), query.until,
      [](std::int64_t until, const BagIndexEntry& entry) { return until < entry.stamp; });
  std::vector<LogLine> lines;
  std::vector<std::uint8_t> content;
  std::size_t read = 0;
  for (auto place = after; place != places.begin() && lines.size() < most && read < kMostLinesRead;
       ++read) {
    --place;
    messages.read(asStored(*place, files.setBack()), content);
    std::optional<LogLine> said = readLogLine(content.data(), content.size());
    if (said && encoder.sourceOf(said->node) == query.node) {
      said->stamp = place->stamp;
      lines.push_back(std::move(*said));
    }
  }
  std::reverse(lines.begin(), lines.end());
  return lines;
}

}  // namespace

std::optional<LogLine> readLogLine(const std::uint8_t* data, std::size_t size) {
  try {
    MessageCursor cursor(data, size);
    for (int i = 0; i < 3; ++i) {
      cursor.number<std::uint32_t>();  // sequence number and stamp of the header
    }
    cursor.string();  // frame
    LogLine line;
    line.level = cursor.number<std::uint8_t>();
    line.node = stableName(std::string(cursor.string().substr(0, kLongestName)));
    std::string text(cursor.string().substr(0, kLongestLine));
    std::replace(text.begin(), text.end(), '\n', ' ');
    line.text = printable(text);
    return line;
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

std::vector<std::vector<LogLine>> lastLogLines(const std::vector<std::string>& paths,
                                               const Encoder& encoder,
                                               const std::vector<LogQuery>& queries,
                                               std::size_t most) {
  const RecordingFiles files(paths);
  const std::vector<BagIndexEntry> places = linesIn(files.index());
  RecordingFiles::Messages messages(files);
  std::vector<std::vector<LogLine>> found;
  for (const LogQuery& query : queries) {
    found.push_back(lastLines(query, places, files, encoder, messages, most));
  }
  return found;
}

}  // namespace self_awareness::ros1
