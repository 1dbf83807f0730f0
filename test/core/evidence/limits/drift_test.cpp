#include "self_awareness/core/evidence/limits/drift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <stdexcept>
#include <vector>

namespace self_awareness::core::evidence {
namespace {

const std::vector<double> kExponents = {1, 0.5, 0.25};

/// What is bet on the sample `k`, from 0, with an exponent: the mean of exponent p^(exponent - 1)
/// over the probabilities p that lots would give it.
double literalPay(const std::vector<double>& shares, std::size_t k, double exponent) {
  constexpr int kSteps = 20000;
  double rank = 0;
  for (std::size_t i = 0; i <= k; ++i) {
    rank += shares[i] >= shares[k] ? 1 : 0;
  }
  double sum = 0;
  for (int step = 0; step < kSteps; ++step) {
    const double v = (step + 0.5) / kSteps;  // most steps where the pay is high
    const double p = (rank - 1 + std::pow(v, 4)) / static_cast<double>(k + 1);
    sum += exponent * std::pow(p, exponent - 1) * 4 * std::pow(v, 3);
  }
  return sum / kSteps;
}

/// The evidence after samples of one component, by all ways from strategy to strategy.
double literalEvidence(const std::vector<double>& shares) {
  constexpr double kGoesOver = 0.01;
  std::size_t ways = 1;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    ways *= kExponents.size();
  }
  std::vector<std::vector<double>> pays(shares.size());
  for (std::size_t k = 0; k < shares.size(); ++k) {
    for (const double exponent : kExponents) {
      pays[k].push_back(literalPay(shares, k, exponent));
    }
  }
  double evidence = 0;
  for (std::size_t way = 0; way < ways; ++way) {
    double stake = 1;
    std::size_t rest = way;
    std::optional<std::size_t> before;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const std::size_t now = rest % kExponents.size();
      rest /= kExponents.size();
      const double stays = before && *before == now ? 1 - kGoesOver : 0;
      stake *= (before ? stays + kGoesOver / 3 : 1.0 / 3) * pays[k][now];
      before = now;
    }
    evidence += stake;
  }
  return evidence;
}

TEST(DriftTest, EvidenceIsThatOfALiteralBetter) {
  const std::vector<double> shares = {0.5, 0.4, 0.6, 0.6, 0.7, 0.1, 0.8};
  Drift drift(1);
  for (const double share : shares) {
    drift.add({share});
  }
  EXPECT_NEAR(drift.component(0).evidence / literalEvidence(shares), 1, 0.005);
  EXPECT_EQ(drift.samples(), shares.size());
  EXPECT_EQ(drift.component(0).usual, 0.6);
  EXPECT_EQ(drift.component(0).last, 0.8);
  EXPECT_EQ(drift.component(0).told_by, 0);
}

TEST(DriftTest, TheFirstSampleSaysNothing) {
  Drift drift(2);
  EXPECT_EQ(drift.component(1).usual, 0);
  drift.add({0.9, 0.1});
  EXPECT_NEAR(drift.component(0).evidence, 1, 1e-12);
  EXPECT_NEAR(drift.component(1).evidence, 1, 1e-12);
  EXPECT_EQ(drift.needed(), 200);
}

TEST(DriftTest, EqualSharesAreNoDrift) {
  Drift drift(1);
  for (int k = 0; k < 1000; ++k) {
    drift.add({0.5});
    ASSERT_LE(drift.component(0).evidence, 1 + 1e-12);
  }
}

TEST(DriftTest, BadSharesAreRefused) {
  Drift drift(2);
  EXPECT_THROW(drift.add({0.5}), std::invalid_argument);
  EXPECT_THROW(drift.add({0.5, -0.1}), std::invalid_argument);
  EXPECT_THROW(drift.add({0.5, std::nan("")}), std::invalid_argument);
  EXPECT_EQ(drift.samples(), 0);
}

TEST(DriftTest, ADriftForYearsOverflowsNothing) {
  Drift drift(1);
  for (int k = 0; k < 2000; ++k) {
    drift.add({static_cast<double>(k)});
  }
  EXPECT_GT(drift.component(0).evidence, drift.needed());
  EXPECT_TRUE(std::isfinite(drift.component(0).evidence));
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

}  // namespace
}  // namespace self_awareness::core::evidence
