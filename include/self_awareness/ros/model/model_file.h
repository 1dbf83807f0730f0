#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "self_awareness/Calibration.h"
#include "self_awareness/EvidenceCalibration.h"
#include "self_awareness/Model.h"
#include "self_awareness/Recording.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/count/halves.h"
#include "self_awareness/core/evidence/limits/coverage.h"
#include "self_awareness/core/evidence/limits/limits.h"
#include "self_awareness/core/paper/delay_statistics.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/file_version.h"

namespace self_awareness::ros1 {

/// A model file that cannot be used; the message names the file and what to do.
class ModelFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a model file holds: counts for the evidence detector, for the paper's, or for both
/// (docs/method.md, sections 2.1 and 3.1).
struct TrainedModel {
  EncodingRules encoding;
  std::int64_t window = core::kDefaultWindow;  ///< length of a window [ns]
  /// Counts of the paper's detector; without delays where there are none, or they were not loaded.
  core::paper::DelayStatistics statistics{core::paper::Binning{}};
  /// All counts of the evidence detector; without event types where there are none, or they were
  /// not loaded. merge() and further training need them.
  core::evidence::Halves evidence;
  /// The part of them that the evidence detector judges by.
  core::evidence::Watched watched;
  core::evidence::Tuning tuning;  ///< the numbers of the method
  core::SourceGraph graph;        ///< whose messages reach whom; empty: not known
  std::vector<self_awareness::Recording> recordings;       ///< that it was trained on
  std::optional<self_awareness::Calibration> calibration;  ///< of the paper's detector
  std::optional<self_awareness::EvidenceCalibration> evidence_calibration;
  /// What the recordings of the training showed to each other; none: not looked at.
  core::evidence::LimitFinder::Findings findings;
  ros::Time stamp;  ///< when it was trained
  /// Of the file that it was read from; of this version if there is none. When it is saved, only
  /// its method stays: that of the oldest counts and limits in it.
  self_awareness::FileVersion version = versionOf(kModelFile);
  /// Channels that its file watches and this version does not have: they are not judged.
  std::set<std::string> left_out;

  const core::Vocabulary& vocabulary() const { return statistics.vocabulary(); }
  /// Whether the model holds the counts of the paper's detector.
  bool hasDelays() const { return statistics.hasDelays(); }
  /// @throw std::invalid_argument if hasDelays() is false; says how to get them
  void requireDelays() const;
  /// Whether the model holds all counts of the evidence detector.
  bool hasEvidence() const { return evidence[0].size() > 0; }
  /// The half that all recordings belong to; none: there are some of both, or no recording.
  std::optional<std::size_t> onlyHalf() const;
  /// Whether watch() has chosen what is watched.
  bool isWatched() const { return watched.halves[0].size() > 0; }
  /// @throw std::invalid_argument if isWatched() is false, or the model was not trained for the
  /// evidence detector
  void requireWatched() const;
  /// What the model was trained for, as far as it was loaded: "evidence", "paper" or "both".
  std::string detectors() const;
  /// Number of gaps between two events of a type.
  std::uint64_t gaps(core::EventId id) const;
  /// Number of ordered pairs of event types with at least one delay.
  std::size_t pairs() const;
  /// Forgets all counts but those that the evidence detector judges by.
  void dropCounts();
  /// Chooses what is watched, by all counts of the evidence detector (docs/method.md, section 3).
  /// @throw std::invalid_argument if hasEvidence() is false
  void watch();
  /// s* of eq. 5; none: not calibrated.
  std::optional<double> threshold() const;
  /// Limits of the evidence; none: not calibrated.
  std::optional<core::evidence::Limits> limits() const;
  /// How soon the evidence detector finds faults of each component; none: not calibrated.
  /// @throw std::invalid_argument as requireWatched(), or if the limits are of another model
  std::vector<core::evidence::Coverage> coverage() const;
};

/// Which counts of a model file are read: with many event types, they take time and memory.
enum class ModelCounts {
  kWatched,  ///< what the evidence detector judges by
  kDelays,   ///< also those of the paper's detector, if there are any
  kAll
};

/// The message on the topic /model of a model file.
self_awareness::Model toMessage(const TrainedModel& model);
/// @throw std::invalid_argument names the contradiction in the message
TrainedModel fromMessage(const self_awareness::Model& message);

/// Writes the whole file or nothing (see OutputFile): no program ever reads half a model.
/// @throw ModelFileError if the file cannot be written
/// @throw std::logic_error if watch() was not called, or counts were dropped
void saveModel(const TrainedModel& model, const std::string& path);
/// Reads a file of any version since the first (docs/files.md).
/// @throw ModelFileError if the file is missing, not a model, too new for this version, or damaged
TrainedModel loadModel(const std::string& path, ModelCounts counts = ModelCounts::kAll);

}  // namespace self_awareness::ros1
