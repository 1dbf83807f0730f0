// Reads every recording of an event log. Only what the header promises may be thrown.

#include <algorithm>

#include "fuzzed_file.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/bag/event_log_reader.h"

using namespace self_awareness;  // NOLINT

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::FuzzedFile file(data, size);
  const std::size_t recordings = ros1::recordingsInEventLog(file.path()).value_or(1);
  core::Vocabulary vocabulary;
  std::uint64_t sum = 0;
  for (std::size_t k = 0; k < std::min<std::size_t>(recordings, 4); ++k) {
    try {
      const ros1::EventLogReader log(file.path(), k);
      log.read(
          *log.summary().encoding,
          [&](const core::EventType& type) { return vocabulary.intern(type); }, {},
          [&](const core::Event& event) {
            sum += static_cast<std::uint64_t>(event.stamp) + event.id;
          });
    } catch (const ros1::BagError&) {
    }
  }
  return 0;
}
