#include "self_awareness/core/evidence/limits/drift_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace self_awareness::core::evidence {
namespace {

using Shares = std::vector<double>;
using Stretch = DriftSamples::Stretch;

constexpr std::int64_t kSecond = kNanosecondsPerSecond;
constexpr std::int64_t kHour = 3600 * kSecond;

/// An hour that was normal. @param start number of the start of the robot; 0: not known
Stretch hour(std::int64_t from, std::int64_t start, const Shares& shares) {
  return {from * kHour, (from + 1) * kHour, start, shares};
}

/// Shares of the last sample so far.
Shares lastOf(const DriftSamples& samples, std::size_t components) {
  Shares last;
  for (std::size_t number = 0; number < components; ++number) {
    last.push_back(samples.drift().component(number).last);
  }
  return last;
}

TEST(DriftSamples, HoursOfAStartAreOneSampleADayAndTheLargestShareCounts) {
  DriftSamples samples(2);
  samples.add(hour(0, 7, {0.1, 0.4}));
  samples.add(hour(1, 7, {0.3, 0.2}));
  samples.add(hour(23, 7, {0.2, 0.2}));
  EXPECT_EQ(samples.drift().samples(), 1U);
  EXPECT_EQ(lastOf(samples, 2), (Shares{0.3, 0.4}));
  samples.add(hour(24, 7, {0, 0}));
  EXPECT_EQ(samples.drift().samples(), 2U) << "the next day of it";
  EXPECT_EQ(lastOf(samples, 2), (Shares{0, 0}));
  samples.add(hour(25, 8, {0.5, 0.5}));
  EXPECT_EQ(samples.drift().samples(), 3U) << "another start";
  samples.add(hour(48, 8, {0.6, 0.5}));
  EXPECT_EQ(samples.drift().samples(), 3U) << "its first day is not over";
  EXPECT_EQ(lastOf(samples, 2), (Shares{0.6, 0.5}));
}

TEST(DriftSamples, WhereTheStartIsNotKnownALongPauseEndsIt) {
  DriftSamples samples(1);
  samples.add({0, 100 * kSecond, 0, {0.1}});
  samples.add({160 * kSecond, 200 * kSecond, 0, {0.2}});
  EXPECT_EQ(samples.drift().samples(), 1U);
  samples.add({261 * kSecond, 300 * kSecond, 0, {0.2}});
  EXPECT_EQ(samples.drift().samples(), 2U);
  samples.add({301 * kSecond, 400 * kSecond, 5, {0.2}});
  EXPECT_EQ(samples.drift().samples(), 3U) << "it was started";
}

TEST(DriftSamples, SayWhatADriftOfTheirSharesSays) {
  DriftSamples samples(1);
  Drift drift(1);
  for (int k = 1; k <= 7; ++k) {
    drift.add({0.1 * k});
    samples.add(hour(0, k, {0.05 * k}));
    samples.add(hour(1, k, {0.1 * k}));
    EXPECT_EQ(samples.drift().component(0).evidence, drift.component(0).evidence);
    EXPECT_EQ(samples.drift().samples(), drift.samples());
  }
  EXPECT_GT(drift.component(0).told_by, 0U);
}

TEST(DriftSamples, WhatIsNoShareIsRefused) {
  DriftSamples samples(2);
  EXPECT_THROW(samples.add(hour(0, 1, {0.1})), std::invalid_argument);
  EXPECT_THROW(samples.add(hour(0, 1, {0.1, -1})), std::invalid_argument);
  EXPECT_THROW(samples.add(hour(0, 1, {0.1, std::nan("")})), std::invalid_argument);
  EXPECT_EQ(samples.drift().samples(), 0U);
}

}  // namespace
}  // namespace self_awareness::core::evidence
