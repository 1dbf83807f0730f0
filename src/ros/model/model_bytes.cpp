#include "self_awareness/ros/model/model_bytes.h"

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "model_fields.h"
#include "model_parts.h"

namespace self_awareness::ros1 {
namespace {

/// Of the package, before all else.
std::string version() {
  ByteWriter bytes;
  bytes(versionOf(kModelFile));
  const std::vector<std::uint8_t> written = bytes.take();
  return {written.begin(), written.end()};
}

TrainedModel readAll(ByteReader& bytes) {
  TrainedModel model = readModel(bytes);
  bool has_delays = false;
  bool has_evidence = false;
  bytes(model.version, has_delays, has_evidence);
  for (core::EventId to = 0; has_delays && to < model.vocabulary().size(); ++to) {
    readDelays(bytes, to, model.statistics);
  }
  for (std::size_t half = 0; has_evidence && half < model.evidence.size(); ++half) {
    model.evidence[half] = readCounts(bytes, model.vocabulary());
    for (core::EventId id = 0; id < model.vocabulary().size(); ++id) {
      readPairs(bytes, id, model.evidence[half]);
    }
  }
  check(bytes.done(), "there is more than belongs to it");
  return model;
}

}  // namespace

std::string toBytes(const TrainedModel& model) {
  ByteWriter bytes;
  writeModel(model, bytes);
  bytes(model.version, model.hasDelays(), model.hasEvidence());
  for (core::EventId to = 0; model.hasDelays() && to < model.vocabulary().size(); ++to) {
    writeDelays(model.statistics, to, bytes);
  }
  for (std::size_t half = 0; model.hasEvidence() && half < model.evidence.size(); ++half) {
    writeCounts(model.evidence[half], bytes);
    for (core::EventId id = 0; id < model.vocabulary().size(); ++id) {
      writePairs(model.evidence[half], id, bytes);
    }
  }
  const std::vector<std::uint8_t> all = bytes.take();
  return version().append(all.begin(), all.end());
}

TrainedModel fromBytes(const std::string& bytes) {
  const std::string expected = version();
  if (bytes.compare(0, expected.size(), expected) != 0) {
    throw std::invalid_argument("a model of another version of self_awareness");
  }
  // They are of this program: they may take any memory.
  ByteReader reader(reinterpret_cast<const std::uint8_t*>(bytes.data()) + expected.size(),
                    bytes.size() - expected.size(), kModelFile.format,
                    std::numeric_limits<std::size_t>::max());
  try {
    return readAll(reader);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("a damaged model: ") + error.what());
  }
}

}  // namespace self_awareness::ros1
