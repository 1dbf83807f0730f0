#include "drift_file.h"

#include <algorithm>
#include <cmath>

#include "one_message_file.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

// The shares take 4 MB at most; the rest is for names.
constexpr OneMessageFile kFile{kDriftFile, "/drift", "the drift in it is damaged", 16 << 20};

void checkContent(const self_awareness::KeptDrift& drift) {
  requireOfFile(!drift.components.empty(), "it is of no component");
  requireOfFile(std::all_of(drift.components.begin(), drift.components.end(),
                            [](const std::string& name) { return name.size() <= kLongestName; }) &&
                    drift.run_id.size() <= kLongestName,
                "a name is too long");
  requireOfFile(drift.shares.size() % drift.components.size() == 0,
                "a sample has a share of each component");
  requireOfFile(drift.shares.size() <= kMostDriftShares &&
                    drift.shares.size() / drift.components.size() <= kMostDriftSamples,
                "there are too many samples");
  requireOfFile(std::all_of(drift.shares.begin(), drift.shares.end(),
                            [](double share) { return std::isfinite(share) && share >= 0; }),
                "a share is none");
}

}  // namespace

std::string pathOfDrift(const std::string& model) {
  return model + ".drift";
}

void writeDrift(const self_awareness::KeptDrift& drift, const std::string& path) {
  writeOneMessage(kFile, drift, toRosTime(drift.end), path);
}

std::optional<self_awareness::KeptDrift> readDrift(const std::string& path) {
  return readOneMessage<self_awareness::KeptDrift>(kFile, path, checkContent);
}

}  // namespace self_awareness::ros1
