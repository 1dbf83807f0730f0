#include "bag_span.h"

#include <rosbag/exceptions.h>

#include <algorithm>
#include <string_view>

#include "bag_records.h"

namespace self_awareness::ros1 {
namespace {

using namespace bag_records;  // NOLINT: the format's words, in this file only

std::int64_t timeIn(std::string_view header, std::string_view name) {
  std::string_view value = field(header, name);
  return takeTime(value);
}

}  // namespace

std::optional<BagSpan> readSpanOfFormat2(const std::string& path) {
  PiecesOfFile file(path);
  if (file.at(0, kFormat.size()) != kFormat) {
    return std::nullopt;
  }
  const PiecesOfFile::Record start = file.record(kFormat.size(), kFileHeaderBytes);
  if (isEncrypted(start.header)) {
    throw EncryptedError();
  }
  auto position = number<std::uint64_t>(start.header, "index_pos");
  const auto connections = number<std::uint32_t>(start.header, "conn_count");
  const auto chunks = number<std::uint32_t>(start.header, "chunk_count");
  if (position == 0) {
    throw rosbag::BagUnindexedException();
  }
  for (std::uint32_t i = 0; i < connections; ++i) {
    position = file.record(position, kLargestConnection).end;
  }
  BagSpan span;
  for (std::uint32_t i = 0; i < chunks; ++i) {
    const PiecesOfFile::Record chunk =
        file.record(position, kMostConnections * 2 * sizeof(std::uint32_t));
    position = chunk.end;
    if (opOf(chunk.header) != Op::kChunkInfo) {
      throw FormatError("a record of another kind");
    }
    const std::int64_t first = timeIn(chunk.header, "start_time");
    span.start = span.messages == 0 ? first : std::min(span.start, first);
    span.end = std::max(span.end, timeIn(chunk.header, "end_time"));
    for (std::string_view counts = chunk.data; !counts.empty();) {
      takeNumber<std::uint32_t>(counts);  // the connection
      span.messages += takeNumber<std::uint32_t>(counts);
    }
  }
  return span;
}

}  // namespace self_awareness::ros1
