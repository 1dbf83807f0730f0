#include "self_awareness/core/evidence/count/gap_distribution.h"

#include <algorithm>
#include <cmath>

#include "core/evidence/count/log_bins.h"

namespace self_awareness::core::evidence {

GapDistribution::GapDistribution(const Statistics::Type& type, const DelayHistogram& gaps)
    : longest_(static_cast<double>(std::max<std::int64_t>(type.longestGap(), 1))),
      number_(static_cast<double>(type.gaps)),
      longest_gaps_(type.longest_gaps),
      gaps_(gaps) {}

double GapDistribution::logSurvival(std::int64_t age) const {
  if (longest_gaps_.empty()) {
    return 0;
  }
  // The longest gaps are known exactly, the others by their bins.
  auto longer =
      static_cast<double>(std::partition_point(longest_gaps_.begin(), longest_gaps_.end(),
                                               [&](std::int64_t gap) { return gap > age; }) -
                          longest_gaps_.begin());
  if (longer == static_cast<double>(longest_gaps_.size())) {
    longer = 0;
    for (std::size_t bin = log_bins::bin(age); bin < gaps_.size(); ++bin) {
      longer += gaps_[bin];
    }
  }
  const double tail = static_cast<double>(age) / longest_;
  const double all = std::log(number_ + 1);
  // If no gap was longer: exp(-tail) would underflow long before its logarithm.
  return longer > 0 ? std::log(longer + std::exp(-tail)) - all : -tail - all;
}

}  // namespace self_awareness::core::evidence
