#include "core/evidence/limits/gap_tail.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace self_awareness::core::evidence {
GapTail::GapTail(const std::vector<std::int64_t>& longest_gaps, double hours, double usual,
                 double cut_off, double samples)
    : samples_(samples) {
  const auto end = std::find_if(longest_gaps.begin(), longest_gaps.end(), [&](std::int64_t gap) {
    return static_cast<double>(gap) <= usual;
  });
  const auto number = static_cast<double>(end - longest_gaps.begin());
  // If all that are kept are pauses, there are more of them.
  const bool more = number > 0 && end == longest_gaps.end();
  shortest_ = more ? static_cast<double>(*std::prev(end)) : usual;
  all_ = number / hours;
  if (number > 0) {
    const double seen = std::accumulate(longest_gaps.begin(), end, 0.0) - number * shortest_;
    excess_ = (seen + std::max(cut_off - (shortest_ - usual), 0.0)) / number;
  }
}

double GapTail::age(double rate) const {
  if (all_ <= 0) {
    return 0;
  }
  const double rarer = std::max(all_ / rate, 1.0);
  return shortest_ + excess_ * samples_ * (std::pow(rarer, 1 / samples_) - 1);
}

}  // namespace self_awareness::core::evidence
