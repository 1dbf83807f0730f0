#include "self_awareness/core/evidence/limits/drift_samples.h"

#include <gtest/gtest.h>

#include <cmath>
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

TEST(DriftSamples, HoursOfAStartAreOneSampleADayAndTheLargestShareCounts) {
  DriftSamples samples(2);
  EXPECT_TRUE(samples.add(hour(0, 7, {0.1, 0.4})));
  EXPECT_TRUE(samples.add(hour(1, 7, {0.3, 0.2})));
  EXPECT_FALSE(samples.add(hour(23, 7, {0.2, 0.2}))) << "nothing new";
  EXPECT_EQ(samples.list(), (std::vector<Shares>{{0.3, 0.4}}));
  EXPECT_TRUE(samples.add(hour(24, 7, {0, 0}))) << "the next day of it";
  EXPECT_TRUE(samples.add(hour(25, 8, {0.5, 0.5}))) << "another start";
  EXPECT_TRUE(samples.add(hour(48, 8, {0.6, 0.5}))) << "its first day is not over";
  EXPECT_EQ(samples.list(), (std::vector<Shares>{{0.3, 0.4}, {0, 0}, {0.6, 0.5}}));
}

TEST(DriftSamples, WhereTheStartIsNotKnownALongPauseEndsIt) {
  DriftSamples samples(1);
  samples.add({0, 100 * kSecond, 0, {0.1}});
  samples.add({160 * kSecond, 200 * kSecond, 0, {0.2}});
  EXPECT_EQ(samples.list().size(), 1U);
  samples.add({261 * kSecond, 300 * kSecond, 0, {0.2}});
  EXPECT_EQ(samples.list().size(), 2U);
  samples.add({301 * kSecond, 400 * kSecond, 5, {0.2}});
  EXPECT_EQ(samples.list().size(), 3U) << "it was started";
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

TEST(DriftSamples, WhatIsToldInTheMiddleOfASampleIsToldAtItsEnd) {
  DriftSamples samples(1);
  for (int k = 1; k <= 6; ++k) {
    samples.add(hour(0, k, {0.1 * k}));
  }
  double before = 0;
  for (const double share : {0.05, 0.15, 0.4, 0.35, 0.65, 0.9}) {
    samples.add(hour(0, 7, {share}));
    EXPECT_GE(samples.drift().component(0).evidence, before) << share;
    before = samples.drift().component(0).evidence;
  }
}

TEST(DriftSamples, GoOnAfterARestart) {
  DriftSamples samples(2);
  samples.add(hour(0, 7, {0.1, 0.4}));
  samples.add(hour(30, 7, {0.3, 0.2}));
  DriftSamples restored(2);
  restored.restore(samples.list(), samples.last());
  for (DriftSamples* const each : {&samples, &restored}) {
    each->add(hour(31, 7, {0.5, 0.1}));
    each->add(hour(32, 8, {0.5, 0.1}));
  }
  EXPECT_EQ(restored.list(), samples.list());
  EXPECT_EQ(restored.list().size(), 3U);
  EXPECT_EQ(restored.drift().component(1).evidence, samples.drift().component(1).evidence);
}

TEST(DriftSamples, AreNoMoreThanTheMost) {
  DriftSamples samples(1, 2);
  EXPECT_TRUE(samples.add(hour(0, 1, {0.1})));
  EXPECT_FALSE(samples.isFull());
  EXPECT_TRUE(samples.add(hour(0, 2, {0.1})));
  EXPECT_TRUE(samples.isFull());
  EXPECT_TRUE(samples.add(hour(1, 2, {0.2}))) << "the last one goes on";
  EXPECT_FALSE(samples.add(hour(0, 3, {0.9})));
  EXPECT_EQ(samples.list(), (std::vector<Shares>{{0.1}, {0.2}}));
}

TEST(DriftSamples, WhatIsNoShareIsRefused) {
  DriftSamples samples(2);
  EXPECT_THROW(samples.add(hour(0, 1, {0.1})), std::invalid_argument);
  EXPECT_THROW(samples.add(hour(0, 1, {0.1, -1})), std::invalid_argument);
  EXPECT_THROW(samples.add(hour(0, 1, {0.1, std::nan("")})), std::invalid_argument);
  EXPECT_THROW(samples.restore({{0.1}}, {}), std::invalid_argument);
  EXPECT_TRUE(samples.list().empty());
}

}  // namespace
}  // namespace self_awareness::core::evidence
