#include "core/evidence/limits/held_out.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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

TEST(HeldOut, ASmallerScaleIsBelievedUntilMoreIsSeen) {
  HeldOut timers(kThreeHours, kScale / 4, kTuning);
  HeldOut others(kThreeHours, kScale, kTuning);
  EXPECT_LT(timers.margin(0.01), others.margin(0.01));
  for (int k = 0; k < 1000; ++k) {
    timers.add({10, 20, 10}, 5);
    others.add({10, 20, 10}, 5);
  }
  EXPECT_NEAR(timers.margin(0.01) / others.margin(0.01), 1, 0.02);
}

TEST(HeldOut, MoreExceedancesNeedAWiderMargin) {
  EXPECT_LT(afterExcesses({1, 1, 1}).margin(0.01), afterExcesses({2, 1, 1}).margin(0.01));
  EXPECT_LT(afterExcesses({2, 1, 1}).margin(0.01), afterExcesses({2, 2, 2}).margin(0.01));
  EXPECT_LT(afterExcesses({2, 2, 2}).margin(0.01), afterExcesses({4, 4, 4}).margin(0.01));
}

}  // namespace
}  // namespace self_awareness::core::evidence
