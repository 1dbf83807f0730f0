#include "self_awareness/core/evidence/count/gap_distribution.h"

#include <algorithm>
#include <cmath>

#include "core/evidence/count/log_bins.h"

namespace self_awareness::core::evidence {

GapDistribution::GapDistribution(const Statistics::Type& type, const DelayHistogram& gaps)
    : number_(static_cast<double>(type.gaps)), longest_gaps_(type.longest_gaps), gaps_(gaps) {
  if (type.gaps == 0) {
    return;
  }
  longest_ = static_cast<double>(std::max<std::int64_t>(type.longestGap(), 1));
  for (std::size_t bin = 0; bin < gaps.size(); ++bin) {
    if (gaps[bin] > 0) {
      const double middle = std::min(log_bins::middle(bin), longest_);
      bins_.push_back({middle, static_cast<double>(gaps[bin]), middle * gaps[bin]});
    }
  }
  for (std::size_t bin = bins_.size(); bin-- > 1;) {
    bins_[bin - 1].count += bins_[bin].count;
    bins_[bin - 1].sum += bins_[bin].sum;
  }
  if (!bins_.empty()) {
    log_all_ = std::log(bins_.front().sum + longest_);
    log_longest_ = std::log(longest_);
  }
}

double GapDistribution::overdue(std::int64_t age) const {
  if (bins_.empty()) {
    return 0;
  }
  const auto a = static_cast<double>(std::max<std::int64_t>(age, 0));
  const auto longer =
      std::upper_bound(bins_.begin(), bins_.end(), a,
                       [](double length, const Bin& bin) { return length < bin.middle; });
  // If no gap was longer: exp(-a / b) would underflow long before its logarithm.
  return longer != bins_.end() ? log_all_ - std::log(longer->sum - a * longer->count +
                                                     longest_ * std::exp(-a / longest_))
                               : log_all_ - log_longest_ + a / longest_;
}

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
