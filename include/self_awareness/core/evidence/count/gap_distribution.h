#pragma once

#include <cstdint>
#include <vector>

#include "self_awareness/core/evidence/count/delay_histogram.h"
#include "self_awareness/core/evidence/count/statistics.h"

namespace self_awareness::core::evidence {

/// How long an event type stays away, by its gaps in training (docs/method.md, section 6).
class GapDistribution {
 public:
  /// @param type counts of the event type
  /// @param gaps between two of its events
  GapDistribution(const Statistics::Type& type, const DelayHistogram& gaps);

  /// Natural logarithm of the probability of a gap of at least this age [ns]: the share of such
  /// gaps in training, with an exponential tail after the longest one; 0 if there is no gap.
  double logSurvival(std::int64_t age) const;

 private:
  double longest_ = 0;                      // [ns]
  double number_;                           // of gaps
  std::vector<std::int64_t> longest_gaps_;  // [ns], the longest first
  DelayHistogram gaps_;
};

}  // namespace self_awareness::core::evidence
