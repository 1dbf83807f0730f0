#include "self_awareness/core/evidence/limits/drift_samples.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kDay = 86400 * kNanosecondsPerSecond;

std::int64_t dayOf(std::int64_t time, std::int64_t start) {
  return static_cast<std::int64_t>(
      std::floor(static_cast<double>(time - start) / static_cast<double>(kDay)));
}

}  // namespace

DriftSamples::DriftSamples(std::size_t components, std::size_t most)
    : components_(components), most_(most), complete_(components) {}

void DriftSamples::restore(const std::vector<std::vector<double>>& samples, const Place& last) {
  for (const std::vector<double>& shares : samples) {
    complete_.check(shares);
    begin(shares);
  }
  last_ = last;
}

bool DriftSamples::add(const Stretch& stretch) {
  complete_.check(stretch.shares);
  const bool same_start =
      !list_.empty() && (stretch.robot_start != 0 ? stretch.robot_start == last_.robot_start
                                                  : stretch.begin - last_.end <= kLongestPause);
  const std::int64_t start = same_start ? last_.start : stretch.begin;
  const std::int64_t day = dayOf(stretch.begin, start);
  if (same_start && day == last_.day) {
    last_.end = stretch.end;
    bool grew = false;
    for (std::size_t number = 0; number < components_; ++number) {
      double& largest = list_.back()[number];
      grew = grew || stretch.shares[number] > largest;
      largest = std::max(largest, stretch.shares[number]);
    }
    return grew;
  }
  if (isFull()) {
    return false;
  }
  last_ = {start, day, stretch.robot_start, stretch.end};
  begin(stretch.shares);
  return true;
}

void DriftSamples::begin(std::vector<double> shares) {
  if (!list_.empty()) {
    complete_.add(list_.back());
  }
  list_.push_back(std::move(shares));
}

Drift DriftSamples::drift() const {
  Drift drift = complete_;
  if (!list_.empty()) {
    drift.add(list_.back());
  }
  return drift;
}

}  // namespace self_awareness::core::evidence
