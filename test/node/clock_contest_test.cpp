#include "node/clock_contest.h"

#include <gtest/gtest.h>

#include "../times.h"

namespace self_awareness {
namespace {

constexpr std::int64_t kTick = kSecond / 40;

class ClockContestTest : public testing::Test {
 protected:
  /// Looks for so long at a clock that runs at this pace.
  void run(double seconds, double pace = 1) {
    for (const std::int64_t end = steady_ + static_cast<std::int64_t>(seconds * kSecond);
         steady_ < end;) {
      steady_ += kTick;
      ros_ += static_cast<std::int64_t>(pace * kTick);
      time_ = contest_.look(ros_, steady_, true);
    }
  }
  /// A look at the clock of another publisher, which is ahead by so much.
  void rivalLooks(std::int64_t ahead) {
    steady_ += kTick;
    ros_ += kTick;
    time_ = contest_.look(ros_ + ahead, steady_, true);
  }

  ClockContest contest_;
  std::int64_t ros_ = 1000 * kSecond;
  std::int64_t steady_ = 5 * kSecond;
  std::int64_t time_ = 0;
};

TEST_F(ClockContestTest, OnePublisherMaySetItsClock) {
  contest_.setPublishers({"/simulator"});
  run(3);
  EXPECT_EQ(time_, ros_);
  ros_ -= 500 * kSecond;
  run(0.1);
  EXPECT_EQ(time_, ros_);
  EXPECT_EQ(contest_.rivals(), "");
}

TEST_F(ClockContestTest, TwoThatAgreeDisturbNobody) {
  contest_.setPublishers({"/a", "/b"});
  run(3);
  rivalLooks(0);
  EXPECT_FALSE(contest_.contested());
  EXPECT_EQ(time_, ros_);
  EXPECT_EQ(contest_.rivals(), "/a and /b");
}

TEST_F(ClockContestTest, TimeGoesOnWhileTwoSetIt) {
  contest_.setPublishers({"/a", "/b"});
  run(3);
  const std::int64_t before = time_;
  for (int i = 0; i < 400; ++i) {
    rivalLooks(i % 2 == 0 ? 7000 * kSecond : 0);
    EXPECT_TRUE(contest_.contested());
    EXPECT_NEAR(static_cast<double>(time_), static_cast<double>(before + (i + 1) * kTick), 1e6);
  }
  EXPECT_EQ(contest_.timeOf(0, steady_), time_) << "what came with a false stamp counts as now";
}

TEST_F(ClockContestTest, TimeGoesOnAtThePaceThatItHad) {
  contest_.setPublishers({"/a", "/b"});
  run(8, 3);
  const std::int64_t before = time_;
  const std::int64_t since = steady_;
  rivalLooks(7000 * kSecond);
  EXPECT_NEAR(static_cast<double>(time_ - before), 3 * static_cast<double>(steady_ - since), 1e7);
}

TEST_F(ClockContestTest, IsOverWhenNobodySetsItForAWhile) {
  contest_.setPublishers({"/a", "/b"});
  run(3);
  rivalLooks(7000 * kSecond);
  rivalLooks(0);
  EXPECT_TRUE(contest_.contested());
  run(9);
  EXPECT_TRUE(contest_.contested());
  run(2);
  EXPECT_FALSE(contest_.contested());
  EXPECT_EQ(time_, ros_);
}

}  // namespace
}  // namespace self_awareness
