// Reads a bag, with the contents of its messages. Only what the header promises may be thrown.

#include <stdexcept>

#include "fuzzed_file.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/bag/bag_reader.h"

using namespace self_awareness;  // NOLINT

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::FuzzedFile file(data, size);
  ros1::EncodingRules rules = ros1::EncodingRules::defaults();
  rules.type_fields["std_msgs/String"] = "data";
  core::Vocabulary vocabulary;
  const ros1::Encoder encoder(
      rules, [&](const core::EventType& type) { return vocabulary.intern(type); });
  std::uint64_t sum = 0;
  try {
    ros1::BagReader(file.path()).read(encoder, {}, [&](const core::Event& event) {
      sum += static_cast<std::uint64_t>(event.stamp) + event.id;
    });
  } catch (const ros1::BagError&) {
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
