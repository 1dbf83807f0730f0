#include "self_awareness/core/evidence/limits/drift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <vector>

#include "self_awareness/core/evidence/limits/drift_samples.h"

namespace self_awareness::core::evidence {
namespace {

TEST(DriftTest, TheFirstSampleAndEqualSharesSayNothingAndADriftForYearsOverflowsNothing) {
  Drift drift(2);
  EXPECT_EQ(drift.component(1).usual, 0);
  EXPECT_EQ(drift.needed(), 200);
  for (int k = 0; k < 2000; ++k) {
    drift.add({0.9, static_cast<double>(k)});
    if (k == 0) {
      EXPECT_NEAR(drift.component(0).evidence, 1, 1e-12);
      EXPECT_NEAR(drift.component(1).evidence, 1, 1e-12);
    }
    ASSERT_LE(drift.component(0).evidence, 1 + 1e-12) << k;
  }
  EXPECT_GT(drift.component(1).evidence, drift.needed());
  EXPECT_TRUE(std::isfinite(drift.component(1).evidence));
}

/// A robot of ten components, whose loads have something in common.
class Robot {
 public:
  static constexpr std::size_t kComponents = 10;

  explicit Robot(unsigned seed) : random_(seed) {}
  /// @param trend of the third component: so many times its usual share
  std::vector<double> day(double trend = 1) {
    const double common = normal_(random_);
    std::vector<double> shares;
    for (std::size_t k = 0; k < kComponents; ++k) {
      shares.push_back(0.6 * std::exp(0.03 * common + 0.04 * normal_(random_)));
    }
    shares[2] *= trend;
    return shares;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

bool told(const Drift& drift) {
  for (std::size_t k = 0; k < Robot::kComponents; ++k) {
    if (drift.component(k).told_by > 0) {
      return true;
    }
  }
  return false;
}

TEST(DriftTest, OfLivesInWhichNothingChangesAtMostOneInAHundredIsTold) {
  constexpr int kLives = 1000;
  constexpr int kDays = 365;
  int lives_told = 0;
  for (int life = 0; life < kLives; ++life) {
    Robot robot(static_cast<unsigned>(life));
    Drift drift(Robot::kComponents);
    for (int day = 0; day < kDays; ++day) {
      drift.add(robot.day());
    }
    lives_told += told(drift) ? 1 : 0;
  }
  EXPECT_LE(lives_told, Drift::kFalseAlarms * kLives);
}

TEST(DriftTest, ADriftOfThreePercentADayIsToldBeforeTheAlarm) {
  constexpr int kRobots = 100;
  for (const int quiet : {20, 60, 300}) {
    int in_time = 0;
    for (int number = 0; number < kRobots; ++number) {
      Robot robot(static_cast<unsigned>(number));
      Drift drift(Robot::kComponents);
      for (int day = 0; day < quiet; ++day) {
        drift.add(robot.day());
      }
      double trend = 1;
      double share = 0;
      while (drift.component(2).told_by == 0 && share <= 1) {
        trend *= 1.03;
        const std::vector<double> shares = robot.day(trend);
        share = shares[2];
        drift.add(shares);
      }
      in_time += share <= 1 && drift.component(2).told_by > static_cast<std::size_t>(quiet);
    }
    EXPECT_GE(in_time, 95) << "after " << quiet << " days";
  }
}

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

TEST(DriftSamples, WhatIsNoShareIsRefused) {
  DriftSamples samples(2);
  EXPECT_THROW(samples.add(hour(0, 1, {0.1})), std::invalid_argument);
  EXPECT_THROW(samples.add(hour(0, 1, {0.1, -1})), std::invalid_argument);
  EXPECT_THROW(samples.add(hour(0, 1, {0.1, std::nan("")})), std::invalid_argument);
  EXPECT_EQ(samples.drift().samples(), 0U);
}

}  // namespace
}  // namespace self_awareness::core::evidence
