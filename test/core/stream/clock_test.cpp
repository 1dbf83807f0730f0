#include "self_awareness/core/stream/clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "self_awareness/core/stream/clock_steps.h"
#include "self_awareness/core/stream/clock_watch.h"

namespace self_awareness::core {
namespace {

constexpr std::int64_t kSecond = kNanosecondsPerSecond;
constexpr std::int64_t kMillisecond = kSecond / 1000;
using Steps = std::vector<std::int64_t>;

// Silences of a robot: from when on, and for how long [ns].
struct Silence {
  std::int64_t from;
  std::int64_t length;
};

std::vector<Event> inOrder(std::vector<Event> events) {
  std::sort(events.begin(), events.end(),
            [](const Event& a, const Event& b) { return a.stamp < b.stamp; });
  return events;
}

// A robot of 10 and 3 Hz for 100 s, and one event at 50 s. Nothing comes in the silences, which
// make the recording longer, as a step of the clock does.
std::vector<Event> robot(const std::vector<Silence>& silences) {
  std::vector<Event> events{{50 * kSecond + 7, 2}};
  for (std::int64_t t = 0; t < 100 * kSecond; t += kSecond / 10) {
    events.push_back({t, 0});
  }
  for (std::int64_t t = 1; t < 100 * kSecond; t += kSecond / 3) {
    events.push_back({t, 1});
  }
  for (Event& event : events) {
    const std::int64_t stamp = event.stamp;
    for (const Silence& silence : silences) {
      event.stamp += stamp >= silence.from ? silence.length : 0;
    }
  }
  return inOrder(std::move(events));
}

TEST(FindClockSteps, ARobotThatGoesOnPausesOrStartsHasNone) {
  const std::int64_t goes_on = 47'770'000'000;
  const auto waits = [&](const Event& event) {
    return 30 * kSecond < event.stamp && event.stamp < goes_on;
  };
  EXPECT_EQ(findClockSteps({}), Steps());
  EXPECT_EQ(findClockSteps({{5, 0}}), Steps());
  EXPECT_EQ(findClockSteps(robot({})), Steps());
  EXPECT_EQ(findClockSteps(robot({{30 * kSecond, kSecond / 4}})), Steps());
  std::vector<Event> events = robot({});
  events.erase(std::remove_if(events.begin(), events.end(), waits), events.end());
  EXPECT_EQ(findClockSteps(events), Steps()) << "after a pause, timers come at another time";
  events = robot({});
  for (Event& event : events) {
    event.stamp = waits(event) ? goes_on : event.stamp;
  }
  EXPECT_EQ(findClockSteps(events), Steps()) << "after an outage, what waited comes at once";
  events.clear();
  for (std::int64_t n = 0; n < 500; ++n) {
    events.push_back({n * kSecond / 10 + (n > 200 ? 60 * kSecond : 0), 0});
  }
  EXPECT_EQ(findClockSteps(events), Steps()) << "one timer tells nothing";
  events = robot({{30 * kSecond, 20 * kSecond}});
  events.push_back({40 * kSecond, 3});
  EXPECT_EQ(findClockSteps(inOrder(events)), Steps()) << "somebody goes on: others are silent";
  events = robot({{0, 20 * kSecond}});
  events.insert(events.begin(), {{0, 0}, {1, 1}, {2, 2}});
  EXPECT_EQ(findClockSteps(events), Steps()) << "a start: some at once, all others a while after";
  events = robot({});
  events.push_back({130 * kSecond, 0});
  EXPECT_EQ(findClockSteps(events), Steps()) << "an end, of which one last message comes later";
  events = robot({});
  const std::vector<Event> again = robot({{10 * kSecond, 2 * kLongestSilence}});
  events.insert(events.end(), again.begin(), again.end());
  EXPECT_EQ(findClockSteps(events), Steps()) << "stamps say these steps themselves";
}

TEST(FindClockSteps, FindsSilencesAfterWhichAllGoesOnUnlessTheyAreOften) {
  EXPECT_EQ(findClockSteps(robot({{30 * kSecond, 20 * kSecond}})), Steps{50 * kSecond});
  EXPECT_EQ(findClockSteps(robot({{30 * kSecond, 3 * kSecond}})), Steps{33 * kSecond});
  EXPECT_EQ(findClockSteps(robot({{30 * kSecond, 2 * kSecond}})), Steps{32 * kSecond});
  EXPECT_EQ(findClockSteps(robot({{30 * kSecond, 20 * kSecond},
                                  {60 * kSecond, 9 * kSecond},
                                  {70 * kSecond, 1800 * kSecond}})),
            (Steps{50 * kSecond, 89 * kSecond, 1899 * kSecond}));
  std::vector<Silence> silences;
  for (std::int64_t n = 1; n <= 4; ++n) {
    silences.push_back({n * 20 * kSecond, 20 * kSecond});
  }
  EXPECT_EQ(findClockSteps(robot(silences)), Steps());
  silences.back().length = 2 * kSecond;  // much shorter than the others
  EXPECT_EQ(findClockSteps(robot(silences)).size(), 3U);
  silences.back().length = 3 * kSecond;
  EXPECT_EQ(findClockSteps(robot(silences)), Steps());
}

TEST(ClockSteps, LieBetweenTheEventsAroundThem) {
  const ClockSteps steps({50, 20});
  EXPECT_TRUE(steps.between(19, 20));
  EXPECT_TRUE(steps.between(3, 90));
  EXPECT_FALSE(steps.between(20, 49));
  EXPECT_TRUE(steps.between(49, 51));
  EXPECT_FALSE(steps.between(50, 90));
  EXPECT_FALSE(ClockSteps().between(0, 90));
}

TEST(ClockWatch, ToleratesSlewAndBusyMomentsAndOfASimulatedClockAnyPaceAndPauses) {
  ClockWatch watch;
  EXPECT_FALSE(watch.look(1000 * kSecond, 0, false));
  EXPECT_FALSE(watch.look(1001 * kSecond, kSecond + 250 * kMillisecond, false));
  EXPECT_FALSE(watch.look(1061 * kSecond, 61 * kSecond, false));  // a minute without a look
  EXPECT_FALSE(watch.isStale(1000 * kSecond));
  ClockWatch simulated;
  EXPECT_FALSE(simulated.look(10 * kSecond, 0, true));
  EXPECT_FALSE(simulated.look(12 * kSecond, 25 * kMillisecond, true));  // eighty times as fast
  EXPECT_FALSE(simulated.look(12 * kSecond, 300 * kSecond, true));      // paused
  EXPECT_FALSE(simulated.look(12050 * kMillisecond, 301 * kSecond, true));
}

TEST(ClockWatch, SeesAClockThatIsSetEitherWay) {
  for (const std::int64_t step : {-3600 * kSecond, -kSecond / 2, kSecond / 2, 3600 * kSecond}) {
    ClockWatch watch;
    watch.look(10000 * kSecond, 0, false);
    EXPECT_TRUE(watch.look(10000 * kSecond + 25 * kMillisecond + step, 25 * kMillisecond, false));
    EXPECT_FALSE(watch.look(10000 * kSecond + 50 * kMillisecond + step, 50 * kMillisecond, false));
    // A message that waited in the queue while the clock was set is of another time.
    EXPECT_TRUE(watch.isStale(10000 * kSecond)) << step;
    EXPECT_FALSE(watch.isStale(10000 * kSecond + 40 * kMillisecond + step)) << step;
  }
  ClockWatch simulated;
  simulated.look(110 * kSecond, 0, true);
  EXPECT_TRUE(simulated.look(100 * kSecond, 25 * kMillisecond, true)) << "a bag loops";
  EXPECT_TRUE(simulated.look(1700000000 * kSecond, 50 * kMillisecond, true)) << "it is reset";
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

}  // namespace
}  // namespace self_awareness::core
