#include "core/evidence/watch/starvation.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "../recordings.h"

namespace self_awareness::core::evidence {
namespace {

// A machine that usually keeps its processes waiting for 4 % of the time.
class StarvationTest : public testing::Test {
 protected:
  StarvationTest() { go(60 * kSecond, 0.04); }
  // Time goes on, while processes wait for this share of it.
  void go(std::int64_t length, double share, std::int64_t step = 50 * kMillisecond) {
    for (std::int64_t passed = 0; passed < length; passed += step) {
      starvation_.add(
          {now_, now_ + step, static_cast<std::int64_t>(share * static_cast<double>(step))});
      now_ += step;
    }
  }

  Starvation starvation_{Tuning{}};
  std::int64_t now_ = 100 * kSecond;
};

TEST_F(StarvationTest, WaitingAsUsualIsNone) {
  EXPECT_EQ(starvation_.waitedIn(0, now_), 0);
  EXPECT_FALSE(starvation_.holdsBack(now_));
  go(kSecond, 0.5);
  EXPECT_EQ(starvation_.waitedIn(0, now_), 0) << "within half of the time above what is usual";
}

TEST_F(StarvationTest, WhatWasWaitedIsForgivenToWhoWasSilentMeanwhile) {
  const std::int64_t begin = now_;
  go(300 * kMillisecond, 0.9);
  EXPECT_EQ(starvation_.waitedIn(begin - kSecond, now_), 270 * kMillisecond);
  EXPECT_EQ(starvation_.waitedIn(begin + 100 * kMillisecond, now_), 180 * kMillisecond);
  EXPECT_EQ(starvation_.waitedIn(now_, now_), 0) << "who was heard at its end did not wait";
  EXPECT_EQ(starvation_.waitedIn(0, now_ - 100 * kMillisecond), 180 * kMillisecond)
      << "a window that ended before";
  const std::int64_t over = now_;
  go(3 * kSecond, 0.04);
  EXPECT_EQ(starvation_.waitedIn(0, over + kRateSpan), 0) << "it is over";
}

TEST_F(StarvationTest, WhatWaitedHasComeAfterAsLongAsItLasted) {
  go(300 * kMillisecond, 0.9);
  const std::int64_t over = now_;
  go(kSecond, 0.04);
  EXPECT_FALSE(starvation_.holdsBack(over - 300 * kMillisecond)) << "it had not begun";
  EXPECT_TRUE(starvation_.holdsBack(over - 100 * kMillisecond));
  EXPECT_TRUE(starvation_.holdsBack(over + 299 * kMillisecond));
  EXPECT_FALSE(starvation_.holdsBack(over + 300 * kMillisecond));
}

TEST_F(StarvationTest, ALoadThatStaysIsUsual) {
  go(700 * kSecond, 0.95, kSecond);
  EXPECT_EQ(starvation_.waitedIn(0, now_), 0);
  starvation_.restart();
  go(70 * kSecond, 0.95, kSecond);
  EXPECT_EQ(starvation_.waitedIn(0, now_), 0) << "it was so from the start";
}

TEST_F(StarvationTest, ALoadThatBeginsSoonIsNotUsual) {
  starvation_.restart();
  go(kSecond, 0);
  go(20 * kSecond, 1);
  EXPECT_EQ(starvation_.waitedIn(0, now_), kRateSpan);
}

TEST_F(StarvationTest, ARestartForgetsIt) {
  go(300 * kMillisecond, 0.9);
  starvation_.restart();
  EXPECT_EQ(starvation_.waitedIn(0, now_), 0);
  EXPECT_FALSE(starvation_.holdsBack(now_));
}

}  // namespace
}  // namespace self_awareness::core::evidence
