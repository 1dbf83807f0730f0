#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/count/halves.h"
#include "self_awareness/core/evidence/limits/coverage.h"
#include "self_awareness/core/evidence/limits/limits.h"
#include "self_awareness/core/evidence/tuning.h"
#include "self_awareness/core/evidence/watch/relation.h"
#include "self_awareness/core/paper/calibration.h"
#include "self_awareness/core/paper/delay_statistics.h"
#include "self_awareness/core/stream/recording_info.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/core/verdict/judge.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core {

/// From where on evidence is abnormal, how that was found, and what is to be expected of it
/// (docs/method.md, section 5).
struct Calibration {
  /// On recordings that were not trained on.
  static constexpr char kHeldOut[] = "held-out";
  /// On each half of the training, learned from the other.
  static constexpr char kCrossFit[] = "cross-fit";

  std::string method;                         ///< kHeldOut or kCrossFit
  evidence::Limits limits;                    ///< of the model's tracks
  std::vector<evidence::Relation> relations;  ///< by track; empty: not known
  double budget = 0;                          ///< false alarms an hour that the limits allow
  double false_alarms_per_hour = 0;           ///< no more (95 %), by leaving starts out in turn
  std::uint64_t windows = 0;                  ///< that were looked at
  std::vector<RecordingInfo> recordings;      ///< of normal operation
  std::int64_t stamp = 0;                     ///< when it was done [ns]; 0: not known
};

/// What was learned of a robot: counts for the evidence detector, for the paper's, or for both,
/// and what they were calibrated to (docs/method.md, sections 2.1 and 3.1). It is made by Learner
/// (learn.h); files hold it (ros/model/model_file.h).
struct Model {
  std::int64_t window = kDefaultWindow;  ///< length of a window [ns]
  /// Counts of the paper's detector; without delays where there are none, or they were not loaded.
  paper::DelayStatistics statistics{paper::Binning{}};
  /// All counts of the evidence detector; without event types where there are none, or they were
  /// not loaded. Further training needs them.
  evidence::Halves evidence;
  /// The part of them that the evidence detector judges by.
  evidence::Watched watched;
  evidence::Tuning tuning;                ///< the numbers of the method
  SourceGraph graph;                      ///< whose messages reach whom; empty: not known
  std::vector<RecordingInfo> recordings;  ///< that it was trained on
  /// What these showed to each other; none: not looked at.
  evidence::LimitFinder::Findings findings;
  std::optional<Calibration> calibration;  ///< of the evidence detector; none: it has no limits
  std::optional<paper::Calibration> paper_calibration;  ///< of the paper's
  std::int64_t stamp = 0;                               ///< when it was trained [ns]; 0: not known

  /// Event types by id.
  const Vocabulary& vocabulary() const { return statistics.vocabulary(); }
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
  std::uint64_t gaps(EventId id) const;
  /// Number of ordered pairs of event types with at least one delay.
  std::size_t pairs() const;
  /// What sources published in training, by source and scope, of which no event came, since nobody
  /// of the robot subscribed to it.
  std::set<SourceGraph::Publication> unheard() const;
  /// What components subscribed to in every recording of the training, from when the start had had
  /// its time to the end (docs/robots.md). Empty: that is not known of all recordings, or
  /// they are of one start.
  std::set<SourceGraph::Subscription> expectedSubscriptions() const;
  /// Forgets all counts but those that the evidence detector judges by.
  void dropCounts();
  /// Forgets what is watched, and all that was found of it: limits, threshold, findings.
  void dropWatched();
  /// Adds what another learner counted, of other recordings: counts to counts, and half to half,
  /// as if one had counted all of them. The order in which models are added decides nothing but
  /// the ids. Edges and recordings are those of both. What was watched is dropped, since it was
  /// chosen by fewer counts: watch() must be called again. Counts do not depend on the numbers of
  /// the method: where those of the two differ, the sum has the defaults.
  /// @throw std::invalid_argument if the two do not count the same things, or were loaded without
  /// their counts; says what it is, and leaves the model as it was
  void add(const Model& other);
  /// Chooses what is watched, by all counts of the evidence detector (docs/method.md, section 3).
  /// Of more than 200 event types, counts of pairs that say too little are left out (section 3.1).
  /// @throw std::invalid_argument if hasEvidence() is false
  void watch();
  /// s* of eq. 5; none: not calibrated.
  std::optional<double> threshold() const;
  /// Limits of the evidence; none: not calibrated.
  std::optional<evidence::Limits> limits() const;
  /// How soon the evidence detector finds faults of each component; none: not calibrated.
  /// @throw std::invalid_argument as requireWatched(), or if the limits are of another model
  std::vector<evidence::Coverage> coverage() const;
  /// Makes the judge of the evidence detector (evidence/judge.h tells more of it).
  /// @param heard event types by id, those of the model first; may grow. None: who sends unknown
  /// events is not known
  /// @throw std::invalid_argument as requireWatched(), or if the limits are of another model
  std::unique_ptr<Judge> makeJudge(std::shared_ptr<const Vocabulary> heard = nullptr) const;
};

}  // namespace self_awareness::core
