#include "core/evidence/watch/stalls.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "../recordings.h"

namespace self_awareness::core::evidence {
namespace {

// The longest silence of training was 40 ms, and so 50 ms are no stall.
class StallsTest : public testing::Test {
 protected:
  StallsTest() { stalls_.add(kStart, false); }
  // The whole robot is silent for so long.
  std::int64_t stall(std::int64_t length, std::int64_t from = kStart) {
    stalls_.add(from, true);
    stalls_.add(from + length, true);
    return from + length;
  }
  Stalls stalls_{40 * kMillisecond, 0, Tuning{}};
};

TEST_F(StallsTest, ASilenceOfAllThatIsLongerThanUsualIsOne) {
  EXPECT_FALSE(stalls_.holdsBack(stall(50 * kMillisecond)));
  EXPECT_TRUE(stalls_.holdsBack(stall(51 * kMillisecond, kStart + kSecond)));
}

TEST_F(StallsTest, WhileThisProgramStoodStillTheRobotDidNot) {
  stalls_.passTo(kStart + 300 * kMillisecond);
  stalls_.add(kStart + 300 * kMillisecond, true);
  EXPECT_FALSE(stalls_.holdsBack(kStart + 300 * kMillisecond));
  stalls_.passTo(kStart);  // it is later already
  EXPECT_TRUE(stalls_.holdsBack(stall(51 * kMillisecond, kStart + kSecond)));
}

TEST_F(StallsTest, WhatWaitedHasComeAfterAsLongAsItLasted) {
  const std::int64_t end = stall(300 * kMillisecond);
  EXPECT_TRUE(stalls_.holdsBack(end + 299 * kMillisecond));
  EXPECT_FALSE(stalls_.holdsBack(end + 300 * kMillisecond));
}

TEST_F(StallsTest, ALongSilenceIsNone) {
  EXPECT_TRUE(stalls_.holdsBack(stall(700 * kMillisecond)));
  stalls_.restart();
  stalls_.add(kStart, false);
  EXPECT_FALSE(stalls_.holdsBack(stall(701 * kMillisecond))) << "the robot is dead";
}

TEST_F(StallsTest, OneAsLongAsInTrainingIsForgiven) {
  stalls_ = Stalls(40 * kMillisecond, kSecond, Tuning{});
  stalls_.add(kStart, false);
  EXPECT_TRUE(stalls_.holdsBack(stall(1250 * kMillisecond)));
  stalls_.restart();
  stalls_.add(kStart, false);
  EXPECT_FALSE(stalls_.holdsBack(stall(1251 * kMillisecond)));
  stalls_ = Stalls(40 * kMillisecond, kRateSpan, Tuning{});
  stalls_.add(kStart, false);
  EXPECT_FALSE(stalls_.holdsBack(stall(kRateSpan + 1))) << "longer ones are judged";
}

TEST_F(StallsTest, OneIsForgivenInSoLongATime) {
  std::int64_t end = stall(300 * kMillisecond);
  end = stall(400 * kMillisecond, end + 20 * kSecond);
  EXPECT_FALSE(stalls_.holdsBack(end));
  end = stall(400 * kMillisecond, end + 10 * kSecond);
  EXPECT_TRUE(stalls_.holdsBack(end));
}

TEST_F(StallsTest, NobodysAgeGrowsMeanwhileNorAfterwards) {
  const std::int64_t stopped = kStart;
  stalls_.closeWindow(stopped + 200 * kMillisecond, true);
  EXPECT_EQ(stalls_.standstillSince(stopped, stopped + 200 * kMillisecond), 200 * kMillisecond);
  const std::int64_t end = stall(300 * kMillisecond);
  const std::int64_t soon = end + 100 * kMillisecond;
  stalls_.add(soon, true);
  stalls_.closeWindow(soon, true);
  EXPECT_EQ(stalls_.standstillSince(stopped - kSecond, soon), 300 * kMillisecond);
  EXPECT_EQ(stalls_.standstillSince(end, soon), 0) << "who came at its end did not wait";
  stalls_.add(end + 3 * kSecond - kMillisecond, true);
  stalls_.closeWindow(end + 3 * kSecond, true);
  EXPECT_EQ(stalls_.standstillSince(stopped, end + 3 * kSecond), 0) << "it is over";
}

TEST_F(StallsTest, ARestartForgetsIt) {
  const std::int64_t end = stall(300 * kMillisecond);
  stalls_.restart();
  EXPECT_FALSE(stalls_.holdsBack(end));
}

}  // namespace
}  // namespace self_awareness::core::evidence
