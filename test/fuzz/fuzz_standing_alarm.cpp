// Reads the alarm that stood when a monitor ended, and looks its suspects up, as the next monitor
// does at its start. Only what the header promises may be thrown.

#include "fuzzed_file.h"
#include "ros/verdict/kept_files.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/bag/bag_reader.h"

using namespace self_awareness;  // NOLINT

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::FuzzedFile file(data, size);
  try {
    if (const auto standing = ros1::readStandingAlarm(file.path())) {
      core::Vocabulary vocabulary;
      vocabulary.intern({"/node", "/topic", "T"});
      ros1::fromMessages(standing->alarm.suspects, vocabulary);
    }
  } catch (const ros1::BagError&) {
  }
  return 0;
}
