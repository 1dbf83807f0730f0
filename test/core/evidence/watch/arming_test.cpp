#include "core/evidence/watch/arming.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "../recordings.h"

namespace self_awareness::core::evidence {
namespace {

constexpr double kUsual = -0.5;
constexpr double kUnusual = 5;

const Tuning kTuning;
const Arming::Numbers kNumbers(kTuning);

// Takes in so many events, or fewer until it is armed; returns their number.
std::uint32_t addUntilArmed(Arming& arming, double surprise, std::uint32_t most) {
  std::uint32_t added = 0;
  for (; added < most && !arming.armed(); ++added) {
    arming.add(surprise, kNumbers);
  }
  return added;
}

TEST(Arming, TakesABlockOfUsualEvents) {
  Arming arming;
  EXPECT_FALSE(arming.armed());
  EXPECT_EQ(addUntilArmed(arming, kUsual, 1000), kNumbers.events);
  EXPECT_FALSE(arming.failed());
}

TEST(Arming, ABlockAsAWholeMustBeUsual) {
  Arming arming;
  arming.add(kUnusual, kNumbers);
  EXPECT_EQ(addUntilArmed(arming, kUsual, 1000), kNumbers.events - 1) << "one of thirty is";
}

TEST(Arming, EveryBlockThatIsNotUsualDoublesTheNextOne) {
  Arming arming;
  std::uint32_t block = kNumbers.events;
  for (int failures = 1; failures < 5; ++failures) {
    addUntilArmed(arming, kUnusual, block);
    EXPECT_TRUE(arming.failed());
    Arming again = arming;
    EXPECT_EQ(addUntilArmed(again, kUsual, 100000), 2 * block);
    block *= 2;
  }
}

TEST(Arming, DoublingEnds) {
  const std::uint32_t kMost = kNumbers.events << Arming::kMostDoublings;
  Arming arming;
  addUntilArmed(arming, kUnusual, 100 * kMost);
  addUntilArmed(arming, kUsual, kMost);
  EXPECT_LE(addUntilArmed(arming, kUsual, 1U << 30U), kMost);
}

TEST(Arming, WhatWasGoneIsArmedAsBefore) {
  Arming arming;
  addUntilArmed(arming, kUnusual, kNumbers.events);
  addUntilArmed(arming, kUsual, 1000);
  arming.disarm();
  EXPECT_FALSE(arming.armed());
  EXPECT_TRUE(arming.failed());
  EXPECT_EQ(addUntilArmed(arming, kUsual, 1000), 2 * kNumbers.events);
}

TEST(Arming, WhatIsAbnormalForLongHasFailed) {
  Arming arming;
  arming.arm();
  std::int64_t end = 7 * kSecond;
  const std::int64_t since = end;
  for (; end < since + kNumbers.accept_after; end += kSecond) {
    EXPECT_FALSE(arming.fails(true, false, end, kNumbers));
  }
  EXPECT_TRUE(arming.fails(true, false, end, kNumbers));
  EXPECT_FALSE(arming.armed());
  EXPECT_TRUE(arming.failed());
  EXPECT_FALSE(arming.fails(true, false, end + 1000 * kSecond, kNumbers)) << "it does not count";
  EXPECT_EQ(addUntilArmed(arming, kUsual, 1000), 2 * kNumbers.events);
}

TEST(Arming, WhatIsOverHasFailedIfItWasNews) {
  for (const std::uint32_t windows : {Arming::kNews - 1, Arming::kNews}) {
    Arming arming;
    arming.arm();
    std::int64_t end = 0;
    for (std::uint32_t k = 0; k < windows; ++k) {
      EXPECT_FALSE(arming.fails(true, false, end += kSecond, kNumbers));
      EXPECT_FALSE(arming.fails(false, false, end += kSecond, kNumbers)) << "something is left";
    }
    const bool failed = arming.fails(false, true, end += kSecond, kNumbers);
    EXPECT_EQ(failed, windows == Arming::kNews);
    EXPECT_EQ(arming.armed(), !failed);
    EXPECT_EQ(arming.failed(), failed);
    // Each episode counts by itself.
    EXPECT_FALSE(arming.fails(true, false, end += kSecond, kNumbers));
    EXPECT_FALSE(arming.fails(false, true, end += kSecond, kNumbers));
  }
}

TEST(Arming, WhatGoesOnBelowItsLimitIsNotOver) {
  Arming arming;
  arming.arm();
  EXPECT_FALSE(arming.fails(true, false, kSecond, kNumbers));
  EXPECT_FALSE(arming.fails(false, false, kNumbers.accept_after, kNumbers));
  EXPECT_TRUE(arming.fails(false, false, kNumbers.accept_after + kSecond, kNumbers));
}

TEST(Arming, WhatNeverWasAbnormalHasNotFailed) {
  Arming arming;
  arming.arm();
  for (std::int64_t end = kSecond; end < 10 * kNumbers.accept_after; end += kSecond) {
    EXPECT_FALSE(arming.fails(false, false, end, kNumbers));
  }
  EXPECT_TRUE(arming.armed());
}

}  // namespace
}  // namespace self_awareness::core::evidence
