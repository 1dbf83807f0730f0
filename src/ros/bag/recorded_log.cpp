#include "recorded_log.h"

#include <cstdint>
#include <utility>

#include "self_awareness/ros/bag/event_log_writer.h"
#include "self_awareness/ros/output_file.h"

namespace self_awareness::ros1 {
namespace {

std::size_t bytesOf(const self_awareness::EventType& type) {
  return sizeof type + type.source.capacity() + type.scope.capacity() + type.type.capacity();
}

}  // namespace

std::size_t bytesOf(const self_awareness::EventLog& part) {
  std::size_t bytes =
      sizeof part + part.packed.capacity() + 3 * sizeof(std::int64_t) * part.waited.capacity();
  for (const self_awareness::EventType& type : part.new_types) {
    bytes += bytesOf(type);
  }
  return bytes;
}

void writeLog(const RecordedLog& recording, const std::string& path) {
  OutputFile file(path);
  EventLogWriter log(file.temporary(), path);
  log.start(recording.start);
  if (recording.graph) {
    log.writeGraph(*recording.graph, static_cast<std::int64_t>(recording.start.begin.toNSec()));
  }
  for (const auto& part : recording.parts) {
    self_awareness::EventLog written = *part;
    if (part == recording.parts.front()) {
      written.new_types.insert(written.new_types.begin(), recording.types_before.begin(),
                               recording.types_before.end());
    }
    log.write(std::move(written));
  }
  log.close();
  file.complete();
}

}  // namespace self_awareness::ros1
