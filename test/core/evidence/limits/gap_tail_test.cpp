#include "core/evidence/limits/gap_tail.h"

#include <gtest/gtest.h>

#include <cmath>

namespace self_awareness::core::evidence {
namespace {

TEST(GapTail, IsExponentialBeyondWhatIsUsual) {
  const GapTail tail({30, 20, 10, 5}, 2, 10);  // two pauses in two hours, 15 longer on average
  EXPECT_DOUBLE_EQ(tail.rate(10), 1);
  EXPECT_DOUBLE_EQ(tail.rate(25), std::exp(-1));
  EXPECT_DOUBLE_EQ(tail.age(std::exp(-1)), 25);
  EXPECT_DOUBLE_EQ(tail.age(5), 10);
}

TEST(GapTail, BeginsWithTheShortestOfThoseThatAreKeptIfAllArePauses) {
  const GapTail tail({30, 20, 16}, 1, 10);
  EXPECT_DOUBLE_EQ(tail.rate(16), 3);
  EXPECT_DOUBLE_EQ(tail.age(3 * std::exp(-1)), 22);
}

TEST(GapTail, OfATypeWithoutGapsIsNone) {  // a model may watch it, if somebody made it so
  const GapTail tail({}, 1, 10);
  EXPECT_DOUBLE_EQ(tail.rate(11), 0);
  EXPECT_DOUBLE_EQ(tail.age(0.1), 10);
}

}  // namespace
}  // namespace self_awareness::core::evidence
