#include "self_awareness/core/evidence/limits/drift_samples.h"

#include <algorithm>
#include <cmath>

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kDay = 86400 * kNanosecondsPerSecond;

std::int64_t dayOf(std::int64_t time, std::int64_t start) {
  return static_cast<std::int64_t>(
      std::floor(static_cast<double>(time - start) / static_cast<double>(kDay)));
}

}  // namespace

void DriftSamples::add(const Stretch& stretch) {
  complete_.check(stretch.shares);
  const bool same_start =
      newest_ && (stretch.robot_start != 0 ? stretch.robot_start == newest_->robot_start
                                           : stretch.begin - newest_->end <= kLongestPause);
  const std::int64_t start = same_start ? newest_->start : stretch.begin;
  const std::int64_t day = dayOf(stretch.begin, start);
  if (same_start && day == newest_->day) {
    newest_->end = stretch.end;
    std::transform(stretch.shares.begin(), stretch.shares.end(), newest_->shares.begin(),
                   newest_->shares.begin(),
                   [](double one, double other) { return std::max(one, other); });
    return;
  }
  complete_ = drift();
  newest_ = Newest{start, day, stretch.robot_start, stretch.end, stretch.shares};
}

Drift DriftSamples::drift() const {
  Drift drift = complete_;
  if (newest_) {
    drift.add(newest_->shares);
  }
  return drift;
}

}  // namespace self_awareness::core::evidence
