#include "core/evidence/watch/stalls.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "../recordings.h"
#include "core/evidence/watch/starvation.h"
#include "self_awareness/core/evidence/watch/machine_stalls.h"

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

TEST_F(StallsTest, ALongOneIsNoneUnlessItIsAsLongAsInTraining) {
  const auto is_one = [&](std::int64_t of_training, std::int64_t length) {
    stalls_ = Stalls(40 * kMillisecond, of_training, Tuning{});
    stalls_.add(kStart, false);
    return stalls_.holdsBack(stall(length));
  };
  EXPECT_TRUE(is_one(0, 700 * kMillisecond));
  EXPECT_FALSE(is_one(0, 701 * kMillisecond)) << "the robot is dead";
  EXPECT_TRUE(is_one(kSecond, 1250 * kMillisecond));
  EXPECT_FALSE(is_one(kSecond, 1251 * kMillisecond));
  EXPECT_FALSE(is_one(kRateSpan, kRateSpan + 1)) << "longer ones are judged";
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

// A robot that is heard every 20 ms.
class MachineStallsTest : public testing::Test {
 protected:
  MachineStallsTest() { stalls_.add(now_); }
  void run(std::int64_t time) {
    for (const std::int64_t end = now_ + time; now_ < end;) {
      stall(20 * kMillisecond);
    }
  }
  void stall(std::int64_t length) { stalls_.add(now_ += length); }
  std::vector<std::int64_t> lengths() const {
    std::vector<std::int64_t> lengths;
    for (const MachineStall& stall : stalls_.find()) {
      lengths.push_back(stall.length);
    }
    return lengths;
  }
  std::int64_t now_ = kStart;
  MachineStalls stalls_{Tuning{}};
};

TEST_F(MachineStallsTest, ASeldomSilenceOfAllIsOne) {
  run(40 * kSecond);
  EXPECT_TRUE(stalls_.find().empty());
  stall(1200 * kMillisecond);
  const std::int64_t end = now_;
  run(40 * kSecond);
  ASSERT_EQ(lengths(), (std::vector<std::int64_t>{1200 * kMillisecond}));
  EXPECT_EQ(stalls_.find()[0].end, end);
}

TEST_F(MachineStallsTest, TheTimeAcrossAStepOfTheClockIsNone) {
  for (const bool seen : {false, true}) {
    stalls_ = MachineStalls(Tuning{});
    now_ = 0;
    stalls_.add(now_);
    if (seen) {
      now_ = 57000000 * kSecond;  // the first /clock
    } else {
      now_ += 300 * kSecond;  // by the tuning, ten stalls are usual
      stalls_.restart();
    }
    stalls_.add(now_);
    for (int k = 0; k < 12; ++k) {
      run(10 * kSecond);
      stall(400 * kMillisecond);
    }
    EXPECT_TRUE(stalls_.find().empty()) << seen;
    run(40 * kSecond);
    stall(501 * kMillisecond);
    EXPECT_EQ(lengths(), (std::vector<std::int64_t>{501 * kMillisecond})) << seen;
  }
}

TEST_F(MachineStallsTest, AStepOfTheClockHidesNone) {
  run(40 * kSecond);
  stall(kSecond);
  run(40 * kSecond);
  now_ = kStart - 10 * kSecond;  // by its stamps, it lies before the one above
  stalls_.add(now_);
  run(40 * kSecond);
  stall(1200 * kMillisecond);
  EXPECT_EQ(lengths(), (std::vector<std::int64_t>{kSecond, 1200 * kMillisecond}));
}

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

TEST_F(StarvationTest, WaitingAsUsualIsNoneNorALoadThatStaysUnlessItBeginsSoon) {
  EXPECT_EQ(starvation_.waitedIn(0, now_), 0);
  EXPECT_FALSE(starvation_.holdsBack(now_));
  go(kSecond, 0.5);
  EXPECT_EQ(starvation_.waitedIn(0, now_), 0) << "within half of the time above what is usual";
  go(700 * kSecond, 0.95, kSecond);
  EXPECT_EQ(starvation_.waitedIn(0, now_), 0);
  starvation_.restart();
  go(70 * kSecond, 0.95, kSecond);
  EXPECT_EQ(starvation_.waitedIn(0, now_), 0) << "it was so from the start";
  starvation_.restart();
  go(kSecond, 0);
  go(20 * kSecond, 1);
  EXPECT_EQ(starvation_.waitedIn(0, now_), kRateSpan);
}

}  // namespace
}  // namespace self_awareness::core::evidence
