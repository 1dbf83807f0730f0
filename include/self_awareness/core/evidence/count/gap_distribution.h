#pragma once

#include <cstdint>
#include <vector>

#include "self_awareness/core/evidence/count/delay_histogram.h"
#include "self_awareness/core/evidence/count/statistics.h"

namespace self_awareness::core::evidence {

/// Nobody waits for longer [ns]: 36 years.
constexpr std::int64_t kLongestAge = std::int64_t{1} << 60;

/// How long an event type stays away, by its gaps in training (docs/method.md, sections 3.2 and
/// 6).
class GapDistribution {
 public:
  /// @param type counts of the event type
  /// @param gaps between two of its events
  GapDistribution(const Statistics::Type& type, const DelayHistogram& gaps);

  /// -log of the probability [nat], at a random moment of normal operation, of an age of at least
  /// `age` [ns]; 0 if there is no gap.
  double overdue(std::int64_t age) const;
  /// Natural logarithm of the probability of a gap of at least this age [ns]: the share of such
  /// gaps in training, with an exponential tail after the longest one; 0 if there is no gap.
  double logSurvival(std::int64_t age) const;

 private:
  /// The gaps of a bin and of all longer ones.
  struct Bin {
    double middle = 0;  // [ns]
    double count = 0;
    double sum = 0;  // [ns]
  };

  // What every window needs comes first: of many event types, fetching it takes most of the time.
  std::vector<Bin> bins_;                   // the shortest gaps first
  double longest_ = 0;                      // [ns]
  double log_all_ = 0;                      // log of the sum of all gaps and the longest one
  double log_longest_ = 0;                  // log of the longest gap
  double number_;                           // of gaps
  std::vector<std::int64_t> longest_gaps_;  // [ns], the longest first
  DelayHistogram gaps_;
};

}  // namespace self_awareness::core::evidence
