#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "self_awareness/Calibration.h"
#include "self_awareness/EvidenceCalibration.h"
#include "self_awareness/Model.h"
#include "self_awareness/Recording.h"
#include "self_awareness/core/evidence/model.h"
#include "self_awareness/core/paper/delay_statistics.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {

/// A model file that cannot be used; the message names the file and the way out.
class ModelFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a model file holds: counts for the evidence detector, for the paper's, or for both.
struct TrainedModel {
  EncodingRules encoding;
  std::int64_t window = core::kDefaultWindow;  ///< length of a window [ns]
  /// Counts of the paper's detector; without delays where there are none, or they were not loaded.
  core::paper::DelayStatistics statistics{core::paper::Binning{}};
  /// All counts of the evidence detector, of the two halves of the training; without event types
  /// where there are none, or they were not loaded. Models are added, and trained on, by these.
  std::array<core::evidence::Statistics, 2> evidence;
  /// What of them the evidence detector judges by.
  core::evidence::Watched watched;
  std::size_t predecessors =
      core::evidence::kPredecessors;  ///< of an event type that are watched at most
  core::SourceGraph graph;            ///< who listens to whom; empty: not known
  std::vector<self_awareness::Recording> recordings;       ///< trained on
  std::optional<self_awareness::Calibration> calibration;  ///< of the paper's detector
  std::optional<self_awareness::EvidenceCalibration> evidence_calibration;
  ros::Time stamp;  ///< when it was trained

  const core::Vocabulary& vocabulary() const { return statistics.vocabulary(); }
  /// Whether it holds the counts of the paper's detector.
  bool hasDelays() const { return statistics.hasDelays(); }
  /// @throw std::invalid_argument if not; says how to get them
  void requireDelays() const;
  /// Whether it holds all counts of the evidence detector.
  bool hasEvidence() const { return evidence[0].size() > 0; }
  /// Whether it was chosen what is watched.
  bool isWatched() const { return watched.halves[0].size() > 0; }
  /// @throw std::invalid_argument if it was not, or not trained for the evidence detector
  void requireWatched() const;
  /// What it was trained for, as far as it was loaded: "evidence", "paper" or "both".
  std::string detectors() const;
  /// Number of gaps between two events of a type.
  std::uint64_t gaps(core::EventId id) const;
  /// Number of ordered pairs of event types with at least one delay.
  std::size_t pairs() const;
  /// Forgets all counts but those that the evidence detector judges by.
  void dropCounts();
  /// Chooses what is watched, by all counts of the evidence detector.
  /// @throw std::invalid_argument if it does not hold them
  void watch();
  /// s* of eq. 5, if the model was calibrated.
  std::optional<double> threshold() const;
  /// Limits of the evidence, if it was calibrated.
  std::optional<core::evidence::Limits> limits() const;
};

/// What of a model file's counts is read: they take time and memory where event types are many.
enum class ModelCounts {
  kWatched,  ///< what the evidence detector judges by
  kDelays,   ///< those of the paper's detector, too, where there are any
  kAll
};

/// The message on /model.
self_awareness::Model toMessage(const TrainedModel& model);
/// @throw std::invalid_argument says what in the message contradicts itself
TrainedModel fromMessage(const self_awareness::Model& message);

/// Writes a temporary file beside `path` and renames it, so that no half-written model is ever
/// seen.
/// @throw ModelFileError
/// @throw std::logic_error if what is watched was not chosen, or counts were dropped
void saveModel(const TrainedModel& model, const std::string& path);
/// @throw ModelFileError if the file is missing, no model, of another version, or damaged
TrainedModel loadModel(const std::string& path, ModelCounts counts = ModelCounts::kAll);

}  // namespace self_awareness::ros1
