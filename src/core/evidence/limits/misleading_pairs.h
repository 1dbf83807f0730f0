#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/evidence/count/log_bins.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/watch/relation.h"

namespace self_awareness::core::evidence {

/// Finds pairs of event types whose delays say less in a part of a recording than in the whole
/// training (docs/method.md, section 5.4): independent timers keep one phase for a while, and what
/// they say then is gone when they drift.
class MisleadingPairs {
 public:
  explicit MisleadingPairs(const Model& model);

  /// Takes in the next event of a recording, in its order.
  /// @param event of a type that the model knows
  void add(const Event& event);
  /// Ends the recording.
  void finish();
  /// Returns what the recording said that has ended, by track, and forgets it.
  std::vector<Said> takeFindings();

 private:
  struct Pair {
    EventId from = 0;
    std::size_t track = 0;
    std::array<double, log_bins::kBins> log_ratios;  // log P_ij - log Q_i [nat], by bin
    double usual_gain = 0;                           // their mean in training [nat]
    DelayHistogram delays{};                         // of the part
  };

  void startPart();
  void closePart();

  Tuning tuning_;
  std::vector<std::vector<Pair>> pairs_;  // by `to`
  std::vector<std::int64_t> last_seen_;   // [ns] by id, kNever before the first in the part
  std::int64_t newest_stamp_ = 0;         // [ns]
  std::int64_t duration_ = 0;             // of the part [ns]
  bool started_ = false;                  // whether the part has an event
  std::vector<Said> said_;                // by track
};

}  // namespace self_awareness::core::evidence
