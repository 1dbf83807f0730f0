#pragma once

#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "self_awareness/FileVersion.h"
#include "self_awareness/core/model.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/file_version.h"

namespace self_awareness::ros1 {

/// A model file that cannot be used; the message names the file and what to do.
class ModelFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a model file holds: a model, and what belongs to ROS and to the file.
struct TrainedModel : core::Model {
  TrainedModel() = default;
  explicit TrainedModel(core::Model model) : core::Model(std::move(model)) {}

  EncodingRules encoding;  ///< how messages became events
  /// Of the file that it was read from; of this version if there is none. When it is saved, only
  /// its method stays: that of the oldest counts and limits in it.
  self_awareness::FileVersion version = versionOf(kModelFile);
  /// Channels that its file watches and this version does not have: they are not judged.
  std::set<std::string> left_out;
};

/// Which counts of a model file are read: with many event types, they take time and memory.
enum class ModelCounts {
  kWatched,  ///< what the evidence detector judges by
  kDelays,   ///< also those of the paper's detector, if there are any
  kAll
};

/// Writes the whole file or nothing (see OutputFile): no program ever reads half a model.
/// @throw ModelFileError if the file cannot be written, or loadModel() would refuse it
/// @throw std::logic_error if watch() was not called, or counts were dropped
void saveModel(const TrainedModel& model, const std::string& path);
/// Reads a file of any version since the first (docs/monitor.md).
/// @throw ModelFileError if the file is missing, not a model, too new for this version, or damaged
TrainedModel loadModel(const std::string& path, ModelCounts counts = ModelCounts::kAll);

/// A model as bytes for another process, with the counts that it holds.
std::string toBytes(const TrainedModel& model);
/// @throw std::invalid_argument if the bytes are of another version of the message, or damaged
TrainedModel fromBytes(const std::string& bytes);

}  // namespace self_awareness::ros1
