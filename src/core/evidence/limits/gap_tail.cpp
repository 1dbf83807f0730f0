#include "core/evidence/limits/gap_tail.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>

namespace self_awareness::core::evidence {
GapTail::GapTail(const std::vector<std::int64_t>& longest_gaps, double hours, double usual) {
  const auto end = std::find_if(longest_gaps.begin(), longest_gaps.end(), [&](std::int64_t gap) {
    return static_cast<double>(gap) <= usual;
  });
  const auto number = static_cast<std::size_t>(end - longest_gaps.begin());
  // If all that are kept are pauses, there are more of them.
  const bool more = number > 0 && number == longest_gaps.size();
  shortest_ = more ? static_cast<double>(*std::prev(end)) : usual;
  all_ = static_cast<double>(number) / hours;
  if (number > 0) {
    mean_excess_ =
        std::accumulate(longest_gaps.begin(), end, 0.0) / static_cast<double>(number) - shortest_;
  }
}

double GapTail::age(double rate) const {
  return shortest_ + mean_excess_ * std::log(std::max(all_ / rate, 1.0));
}

double GapTail::rate(double age) const {
  if (age <= shortest_) {
    return all_;
  }
  return mean_excess_ > 0 ? all_ * std::exp((shortest_ - age) / mean_excess_) : 0;
}

}  // namespace self_awareness::core::evidence
