#include "core/evidence/limits/left_out.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/evidence/limits/gap_tail.h"

namespace self_awareness::core::evidence {
namespace {

std::size_t exceeded(const std::vector<Part>& parts, const std::vector<double>& largest,
                     double least = 1, double margin = 1.5) {
  LeftOut left_out(parts);
  left_out.add(largest, largest, least, margin);
  return left_out.exceeded();
}

TEST(LeftOut, AStartIsJudgedByTheOthersAndAPartOfALongOneByItsOtherParts) {
  const std::vector<Part> parts{{0, 1}, {0, 1}, {1, 2}, {2, 2}};
  EXPECT_EQ(exceeded(parts, {2, 2, 2, 3}), 0U);
  EXPECT_EQ(exceeded(parts, {2, 2, 2, 3.1}), 1U);
  EXPECT_EQ(exceeded(parts, {3.1, 3.1, 2, 2}), 2U) << "each of its parts";
  EXPECT_EQ(exceeded(parts, {3.1, 2, 2, 2}), 1U);
  EXPECT_EQ(exceeded(parts, {0.9, 0, 0, 0}), 0U) << "below the least limit";
  EXPECT_EQ(exceeded(parts, {1.1, 0, 0, 0}), 1U);
  EXPECT_EQ(exceeded(parts, {5, 0, 0, 0}, 0), 0U) << "the others know nothing of it";
  const std::vector<Part> long_start{{0, 1}, {0, 1}, {0, 1}, {1, 1}};
  EXPECT_EQ(exceeded(long_start, {4, 2, 2, 2}), 1U);
  EXPECT_EQ(exceeded(long_start, {4, 4, 2, 2}), 0U);
}

TEST(LeftOut, WhatIsMostOfAllIsNotJudged) {
  LeftOut left_out({{0, 5}, {1, 1}, {2, 1}});
  left_out.add({9, 2, 2}, {9, 2, 2}, 1, 1.5);
  EXPECT_EQ(left_out.exceeded(), 0U);
  EXPECT_DOUBLE_EQ(left_out.hours(), 2);
  EXPECT_DOUBLE_EQ(LeftOut({{0, 5}}).hours(), 5) << "nothing can be left out";
}

TEST(LeftOut, APartCountsOnceAndWhatMostStartsDoNotAgreeOnTellsNothingAboutOthers) {
  const std::vector<Part> parts{{0, 1}, {1, 1}, {2, 1}};
  LeftOut left_out(parts);
  for (int k = 0; k < 5; ++k) {  // tracks
    left_out.add({9, 2, 2}, {9, 2, 2}, 1, 1.5);
  }
  left_out.add({2, 9, 2}, {2, 9, 2}, 1, 1.5);
  EXPECT_EQ(left_out.exceeded(), 2U);
  LeftOut agreed(parts);
  agreed.add({9, 4, 2}, {2, 4, 2}, 1, 1.5);
  EXPECT_EQ(agreed.exceeded(), 2U) << "the first, and by the agreed also the second";
}

TEST(LeftOut, TheHighestRateIsThatOfRobotsAndOfWhatOneShows) {
  // 95 % quantiles of gamma distributions; half an hour is known of all robots.
  EXPECT_NEAR(highestRate(0, 0.5), 0.58, 0.01);
  EXPECT_NEAR(highestRate(1, 0.5), 1.92, 0.06);
  EXPECT_NEAR(highestRate(2, 0.5), 2.996, 0.03);
  EXPECT_NEAR(highestRate(20, 0.5), 15.71, 0.03);
  EXPECT_NEAR(highestRate(200, 9.5), 11.70, 0.03);
  EXPECT_LT(highestRate(0, 10), 0.06) << "hours without an alarm promise more";
}

TEST(GapTail, IsWhatFewPausesLetExpect) {
  // Two pauses in two hours, 15 longer on average.
  const auto age = [](double cut_off, double samples, double rate) {
    return GapTail({30, 20, 10, 5}, 2, 10, cut_off, samples).age(rate);
  };
  EXPECT_DOUBLE_EQ(age(0, 2, 0.25), 40) << "(1 + 30 / (2 * 15)) to the power of -2";
  EXPECT_DOUBLE_EQ(age(0, 2, 5), 10);
  EXPECT_DOUBLE_EQ(age(0, 1, 0.5), 25) << "longer: fewer samples tell it; 1 / (1 + 15 / 15)";
  EXPECT_NEAR(age(0, 1e9, std::exp(-1)), 25, 1e-4) << "exponential where many do";
  EXPECT_DOUBLE_EQ(age(30, 2, 0.25), 70) << "30 more on average, which recordings cut off";
  EXPECT_EQ(GapTail({9, 8, 7}, 1, 10, 0, 2).age(0.1), 0) << "no gap is longer than usual";
  EXPECT_EQ(GapTail({}, 1, 10, 0, 2).age(0.1), 0);
}

TEST(GapTail, BeginsWithTheShortestOfThoseThatAreKeptIfAllArePauses) {
  const GapTail tail({30, 20, 16}, 1, 10, 0, 3);
  EXPECT_DOUBLE_EQ(tail.age(3), 16);
  EXPECT_DOUBLE_EQ(tail.age(3.0 / 8), 34) << "16 + 18 (8 to the power of 1/3, minus 1)";
}

}  // namespace
}  // namespace self_awareness::core::evidence
