#include "core/evidence/limits/gap_tail.h"

#include <gtest/gtest.h>

#include <cmath>

namespace self_awareness::core::evidence {
namespace {

TEST(GapTail, IsWhatFewPausesLetExpect) {
  const GapTail tail({30, 20, 10, 5}, 2, 10, 0, 9,
                     0);  // two pauses in two hours, 15 longer on average
  EXPECT_DOUBLE_EQ(tail.age(0.25), 40) << "(1 + 30 / (2 * 15)) to the power of -2";
  EXPECT_DOUBLE_EQ(tail.age(5), 10);
}

TEST(GapTail, IsExponentialWhereManyPausesAreBelieved) {
  const GapTail tail({30, 20, 10, 5}, 2, 10, 0, 9, 1e6);
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
