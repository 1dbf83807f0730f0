#include "node/processor_watch.h"

#include <gtest/gtest.h>

#include "../times.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness {
namespace {

constexpr std::int64_t kPause = kSecond / 40;

// The clocks are the test's, the kernel's pressure is the machine's: what a look says may be more
// than what the test says, but never less.
class ProcessorWatchTest : public testing::Test {
 protected:
  ProcessorWatchTest() { EXPECT_FALSE(watch_.look(kStart, 0, kPause)) << "nothing has passed"; }

  ProcessorWatch watch_;
};

TEST_F(ProcessorWatchTest, TimeIsToldAfterASecondAtTheLatest) {
  std::int64_t told = 0;
  std::int64_t until = kStart;
  for (std::int64_t now = kPause; now <= 10 * kSecond; now += kPause) {
    if (const auto waiting = watch_.look(kStart + now, now, kPause)) {
      EXPECT_EQ(waiting->from, until) << "one stretch after the other";
      EXPECT_LE(waiting->to - waiting->from, kSecond);
      EXPECT_LE(waiting->waited, waiting->to - waiting->from);
      until = waiting->to;
      ++told;
    }
  }
  EXPECT_GE(told, 10);
  EXPECT_GT(until, kStart + 9 * kSecond);
}

TEST_F(ProcessorWatchTest, ALookThatComesLateIsToldAtOnceAtThePaceOfTime) {
  for (const std::int64_t pace : {1, 10}) {  // simulated time has its own
    ProcessorWatch watch;
    EXPECT_FALSE(watch.look(kStart, 0, kPause));
    const auto waiting = watch.look(kStart + 4 * pace * kPause, 4 * kPause, kPause);
    ASSERT_TRUE(waiting);
    EXPECT_EQ(waiting->from, kStart);
    EXPECT_EQ(waiting->to, kStart + 4 * pace * kPause);
    // Of the three pauses too many, this thread had some microseconds itself.
    EXPECT_GT(waiting->waited, pace * (3 * kPause - kSecond / 100));
  }
}

TEST_F(ProcessorWatchTest, AStandstillBeginsWithTheLastLook) {
  // A monitor hears the first message between two looks, and stands still soon after.
  const std::int64_t last = 2 * kPause;
  watch_.look(kStart + kPause, kPause, kPause);
  watch_.look(kStart + last, last, kPause);
  const auto pause = watch_.look(kStart + last + 2 * kSecond, last + 2 * kSecond, kPause);
  ASSERT_TRUE(pause);
  EXPECT_EQ(pause->from, kStart + last);
  EXPECT_TRUE(pause->stoodStill());
}

TEST_F(ProcessorWatchTest, WhereTimeWasSetItBeginsAnew) {
  EXPECT_FALSE(watch_.look(kStart - kSecond, 4 * kPause, kPause));
  watch_.restart();
  EXPECT_FALSE(watch_.look(kStart + 100 * kSecond, 8 * kPause, kPause));
}

}  // namespace
}  // namespace self_awareness
