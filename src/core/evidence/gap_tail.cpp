#include "core/evidence/gap_tail.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace self_awareness::core::evidence {
namespace {

constexpr std::size_t kTailGaps = 20;

}  // namespace

GapTail::GapTail(const std::vector<std::int64_t>& longest_gaps, double hours) {
  const std::size_t number = std::min(longest_gaps.size(), kTailGaps);
  const auto end = longest_gaps.begin() + static_cast<std::ptrdiff_t>(number);
  shortest_ = static_cast<double>(longest_gaps[number - 1]);
  mean_excess_ =
      std::accumulate(longest_gaps.begin(), end, 0.0) / static_cast<double>(number) - shortest_;
  all_ = static_cast<double>(number) / hours;
}

double GapTail::age(double rate) const {
  return shortest_ + mean_excess_ * std::max(std::log(all_ / rate), 0.0);
}

double GapTail::rate(double age) const {
  if (age <= shortest_) {
    return all_;
  }
  return mean_excess_ > 0 ? all_ * std::exp((shortest_ - age) / mean_excess_) : 0;
}

}  // namespace self_awareness::core::evidence
