#include "core/evidence/limits/held_out.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/evidence/limits/gap_tail.h"
#include "core/evidence/limits/left_out.h"

namespace self_awareness::core::evidence {
namespace {

// Three starts of an hour, each of one part.
const std::vector<Part> kThreeHours{{0, 1}, {1, 1}, {2, 1}};
// What is believed of the logarithms of excesses before anything is seen.
constexpr double kScale = 0.2;
const Tuning kTuning;

// Tracks whose largest value is this many times the next one.
HeldOut afterExcesses(const std::vector<double>& excesses) {
  HeldOut held_out(kThreeHours, kScale, kTuning);
  for (const double excess : excesses) {
    held_out.add({10, 10 * excess, 7}, 5);
  }
  return held_out;
}

TEST(HeldOut, TheExcessIsOverTheLargestOfAllOtherStarts) {
  const HeldOut held_out({{0, 1}, {0, 1}, {1, 1}, {2, 1}}, kScale, kTuning);
  EXPECT_DOUBLE_EQ(held_out.excess({1, 3, 6, 2}, 1), 2);
  EXPECT_DOUBLE_EQ(held_out.excess({6, 6, 3, 2}, 1), 2) << "parts of one start belong together";
  EXPECT_DOUBLE_EQ(held_out.excess({6, 6, 6, 6}, 1), 1);
}

TEST(HeldOut, WhatStaysBelowTheLeastLimitDoesNotMatter) {
  const HeldOut held_out(kThreeHours, kScale, kTuning);
  EXPECT_DOUBLE_EQ(held_out.excess({1, 0.9, 0.1}, 1), 1);
  EXPECT_DOUBLE_EQ(held_out.excess({3, 0, 0}, 1), 3 / kTuning.share_of_least);
  EXPECT_DOUBLE_EQ(held_out.excess({3, 0.9, 0}, 1), 3 / 0.9);
  EXPECT_DOUBLE_EQ(held_out.excess({0, 0, 0}, 0), 1);
  EXPECT_DOUBLE_EQ(held_out.excess({0, 7, 0}, 0), 1) << "the others know nothing of it";
}

TEST(HeldOut, WhatIsLongerThanTheRestIsNotJudgedByIt) {
  const HeldOut held_out({{0, 5}, {1, 1}, {2, 1}}, kScale, kTuning);
  EXPECT_DOUBLE_EQ(held_out.excess({8, 2, 2}, 1), 1);
  EXPECT_DOUBLE_EQ(held_out.excess({2, 8, 2}, 1), 4);
}

TEST(HeldOut, OneRecordingAllowsNoEstimate) {
  HeldOut held_out({{0, 1}}, kScale, kTuning);
  held_out.add({100}, 1);
  EXPECT_DOUBLE_EQ(held_out.margin(1e-9), 1);
  EXPECT_DOUBLE_EQ(held_out.excess({100}, 1), 1);
}

TEST(HeldOut, OneStartIsStillJudgedByItsParts) {
  HeldOut held_out({{0, 1}, {0, 1}, {0, 1}}, kScale, kTuning);
  held_out.add({10, 20, 10}, 5);
  EXPECT_DOUBLE_EQ(held_out.excess({10, 20, 10}, 5), 1) << "of starts";
  EXPECT_GT(held_out.margin(0.01), 1.25);
}

TEST(HeldOut, TheMarginFollowsAnExponentialTailOfLogarithms) {
  // One track of three hours exceeds the others by a factor of 3. What was believed before weighs
  // as much as five exceedances of 0.2; excesses below 1.1 do not count.
  const double scale = (std::log(3.0) - std::log(1.1) + 5 * kScale) / (1 + 5);
  const HeldOut held_out = afterExcesses({3, 1.05, 1});
  for (const double rate : {0.1, 0.01, 0.001}) {
    EXPECT_NEAR(held_out.margin(rate), 1.1 * std::pow(1 / (3 * rate), scale), 1e-12);
  }
}

TEST(HeldOut, WithoutAnExceedanceTheMarginIsMadeForHalfAnOne) {
  const HeldOut held_out = afterExcesses({1, 1});
  EXPECT_NEAR(held_out.margin(0.01), 1.1 * std::pow(0.5 / (3 * 0.01), kScale), 1e-12);
}

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

TEST(GapTail, IsWhatFewPausesLetExpect) {
  const GapTail tail({30, 20, 10, 5}, 2, 10, 0, 9,
                     0);  // two pauses in two hours, 15 longer on average
  EXPECT_DOUBLE_EQ(tail.age(0.25), 40) << "(1 + 30 / (2 * 15)) to the power of -2";
  EXPECT_DOUBLE_EQ(tail.age(5), 10);
}

TEST(GapTail, IsExponentialWhereManyPausesAreBelieved) {
  const GapTail tail({30, 20, 10, 5}, 2, 10, 0, 9, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(tail.age(std::exp(-1)), 25, 1e-4);
}

TEST(GapTail, PausesOfOneStartAreOneSample) {
  const GapTail tail({30, 20, 10, 5}, 2, 10, 0, 1, 0);
  EXPECT_DOUBLE_EQ(tail.age(0.5), 25) << "1 / (1 + 15 / 15)";
}

TEST(GapTail, KnowsSilencesThatRecordingsCutOff) {
  const GapTail tail({30, 20, 10, 5}, 2, 10, 30, 9, 0);  // 30 more on average of the two
  EXPECT_DOUBLE_EQ(tail.age(0.25), 70);
}

TEST(GapTail, BeginsWithTheShortestOfThoseThatAreKeptIfAllArePauses) {
  const GapTail tail({30, 20, 16}, 1, 10, 0, 9, 0);
  EXPECT_DOUBLE_EQ(tail.age(3), 16);
  EXPECT_DOUBLE_EQ(tail.age(3.0 / 8), 34) << "16 + 18 (8 to the power of 1/3, minus 1)";
}

TEST(GapTail, OfATypeWithoutGapsIsNone) {  // a model may watch it, if somebody made it so
  const GapTail tail({}, 1, 10, 0, 9, 2);
  EXPECT_DOUBLE_EQ(tail.age(0.1), 10);
}

}  // namespace
}  // namespace self_awareness::core::evidence
