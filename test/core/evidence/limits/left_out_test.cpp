#include "core/evidence/limits/left_out.h"

#include <gtest/gtest.h>

#include <vector>

namespace self_awareness::core::evidence {
namespace {

const Tuning kTuning;

std::size_t exceeded(const std::vector<Part>& parts, const std::vector<double>& largest,
                     double least = 1, double margin = 1.5) {
  LeftOut left_out(parts, kTuning);
  left_out.add(largest, largest, least, margin);
  return left_out.exceeded();
}

TEST(LeftOut, AStartIsJudgedByTheOthers) {
  const std::vector<Part> parts{{0, 1}, {0, 1}, {1, 2}, {2, 2}};
  EXPECT_EQ(exceeded(parts, {2, 2, 2, 3}), 0U);
  EXPECT_EQ(exceeded(parts, {2, 2, 2, 3.1}), 1U);
  EXPECT_EQ(exceeded(parts, {3.1, 3.1, 2, 2}), 2U) << "each of its parts";
  EXPECT_EQ(exceeded(parts, {3.1, 2, 2, 2}), 1U);
  EXPECT_EQ(exceeded(parts, {0.9, 0, 0, 0}), 0U) << "below the least limit";
  EXPECT_EQ(exceeded(parts, {1.1, 0, 0, 0}), 1U);
  EXPECT_EQ(exceeded(parts, {5, 0, 0, 0}, 0), 0U) << "the others know nothing of it";
}

TEST(LeftOut, APartOfALongStartIsJudgedByTheOtherParts) {
  const std::vector<Part> parts{{0, 1}, {0, 1}, {0, 1}, {1, 1}};
  EXPECT_EQ(exceeded(parts, {4, 2, 2, 2}), 1U);
  EXPECT_EQ(exceeded(parts, {4, 4, 2, 2}), 0U);
}

TEST(LeftOut, WhatIsMostOfAllIsNotJudged) {
  LeftOut left_out({{0, 5}, {1, 1}, {2, 1}}, kTuning);
  left_out.add({9, 2, 2}, {9, 2, 2}, 1, 1.5);
  EXPECT_EQ(left_out.exceeded(), 0U);
  EXPECT_DOUBLE_EQ(left_out.hours(), 2);
  EXPECT_DOUBLE_EQ(LeftOut({{0, 5}}, kTuning).hours(), 5) << "nothing can be left out";
}

TEST(LeftOut, APartCountsOnceWhateverNumberOfTracksExceed) {
  LeftOut left_out({{0, 1}, {1, 1}, {2, 1}}, kTuning);
  for (int k = 0; k < 5; ++k) {
    left_out.add({9, 2, 2}, {9, 2, 2}, 1, 1.5);
  }
  left_out.add({2, 9, 2}, {2, 9, 2}, 1, 1.5);
  EXPECT_EQ(left_out.exceeded(), 2U);
}

TEST(LeftOut, WhatMostStartsDoNotAgreeOnTellsNothingAboutOthers) {
  LeftOut left_out({{0, 1}, {1, 1}, {2, 1}}, kTuning);
  left_out.add({9, 4, 2}, {2, 4, 2}, 1, 1.5);
  EXPECT_EQ(left_out.exceeded(), 2U) << "the first, and by the agreed also the second";
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

}  // namespace
}  // namespace self_awareness::core::evidence
