#include "core/evidence/limits/gap_tail.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace self_awareness::core::evidence {
namespace {

TEST(GapTail, ExtrapolatesThePausesAsAnExponentialOne) {
  // In two hours: of what is longer than 100, a mean excess of 100.
  const GapTail tail({300, 200, 100, 50}, 2, 100);
  EXPECT_NEAR(tail.rate(100), 1, 1e-12);
  EXPECT_NEAR(tail.rate(400), std::exp(-300 / 150.0), 1e-12);
  EXPECT_NEAR(tail.age(tail.rate(777)), 777, 1e-9);
  EXPECT_EQ(tail.age(10), 100) << "more often than all of them";
}

TEST(GapTail, IfAllThatAreKeptArePausesItBeginsWithTheShortest) {
  const GapTail tail({400, 300, 200}, 1, 100);
  EXPECT_EQ(tail.rate(200), 3);
  EXPECT_NEAR(tail.rate(300), 3 * std::exp(-1), 1e-12);
}

TEST(GapTail, WithoutAPauseNoneIsExpected) {
  for (const std::vector<std::int64_t>& gaps :
       std::vector<std::vector<std::int64_t>>{{}, {90, 80}}) {
    const GapTail tail(gaps, 1, 100);
    EXPECT_EQ(tail.rate(200), 0);
    EXPECT_EQ(tail.age(0.001), 100);
  }
}

}  // namespace
}  // namespace self_awareness::core::evidence
