#include "self_awareness/core/stream/clock_watch.h"

#include <gtest/gtest.h>

namespace self_awareness::core {
namespace {

constexpr std::int64_t kMillisecond = 1000000;
constexpr std::int64_t kSecond = 1000 * kMillisecond;

TEST(ClockWatch, ToleratesSlewAndBusyMoments) {
  ClockWatch watch;
  EXPECT_FALSE(watch.look(1000 * kSecond, 0, false));
  EXPECT_FALSE(watch.look(1001 * kSecond, kSecond + 250 * kMillisecond, false));
  EXPECT_FALSE(watch.look(1061 * kSecond, 61 * kSecond, false));  // a minute without a look
  EXPECT_FALSE(watch.isStale(1000 * kSecond));
}

TEST(ClockWatch, SeesAWallClockThatIsSetEitherWay) {
  for (const std::int64_t step : {-3600 * kSecond, -kSecond / 2, kSecond / 2, 3600 * kSecond}) {
    ClockWatch watch;
    watch.look(10000 * kSecond, 0, false);
    EXPECT_TRUE(watch.look(10000 * kSecond + 25 * kMillisecond + step, 25 * kMillisecond, false));
    EXPECT_FALSE(watch.look(10000 * kSecond + 50 * kMillisecond + step, 50 * kMillisecond, false));
    // A message that waited in the queue while the clock was set is of another time.
    EXPECT_TRUE(watch.isStale(10000 * kSecond)) << step;
    EXPECT_FALSE(watch.isStale(10000 * kSecond + 40 * kMillisecond + step)) << step;
  }
}

TEST(ClockWatch, ASimulatedClockMayRunAtAnyPaceAndPause) {
  ClockWatch watch;
  EXPECT_FALSE(watch.look(10 * kSecond, 0, true));
  EXPECT_FALSE(watch.look(12 * kSecond, 25 * kMillisecond, true));  // eighty times as fast
  EXPECT_FALSE(watch.look(12 * kSecond, 300 * kSecond, true));      // paused
  EXPECT_FALSE(watch.look(12050 * kMillisecond, 301 * kSecond, true));
}

TEST(ClockWatch, SaysHowLongASimulatedClockStandsStill) {
  ClockWatch watch;
  watch.look(0, 5 * kSecond, true);
  watch.look(0, 7 * kSecond, true);
  EXPECT_EQ(watch.standsStillFor(), 2 * kSecond);
  watch.look(1000 * kSecond, 8 * kSecond, true);
  EXPECT_EQ(watch.standsStillFor(), 0);
  watch.look(1000 * kSecond, 20 * kSecond, true);
  EXPECT_EQ(watch.standsStillFor(), 12 * kSecond);
  EXPECT_EQ(watch.pause(), 12 * kSecond);
  watch.look(1000 * kSecond, 21 * kSecond, false);
  EXPECT_EQ(watch.standsStillFor(), 0);
}

TEST(ClockWatch, SeesABagThatLoopsAndASimulationThatIsReset) {
  ClockWatch watch;
  watch.look(110 * kSecond, 0, true);
  EXPECT_TRUE(watch.look(100 * kSecond, 25 * kMillisecond, true));
  EXPECT_TRUE(watch.look(1700000000 * kSecond, 50 * kMillisecond, true));
}

}  // namespace
}  // namespace self_awareness::core
