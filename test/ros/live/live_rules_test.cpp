// What the live side decides without a master: which topics, what its own output is, and when the
// clock was set.

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/live/clock_watch.h"
#include "self_awareness/ros/live/own_output.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::int64_t kMillisecond = 1000000;
constexpr std::int64_t kSecond = 1000 * kMillisecond;
using Topics = std::set<std::string>;

Topics choose(SubscribePolicy policy) {
  Graph graph;
  graph.topics["/scan"] = {"sensor_msgs/LaserScan", {"/player"}, {"/slam", "/self_awareness"}};
  graph.topics["/camera/points"] = {"sensor_msgs/PointCloud2", {"/camera"}, {}};
  graph.topics["/camera/rect"] = {"sensor_msgs/Image", {"/camera"}, {"/self_awareness"}};
  graph.topics["/goal"] = {"geometry_msgs/PoseStamped", {}, {"/navigation"}};
  graph.topics["/clock"] = {"rosgraph_msgs/Clock", {"/gazebo"}, {"/slam"}};
  return chooseTopics(
      graph, policy, {"/pose"}, [](const std::string& topic) { return topic != "/clock"; },
      "/self_awareness");
}

TEST(ChooseTopics, UsedLeavesLazyPublishersAsleep) {
  EXPECT_EQ(choose(SubscribePolicy::kUsed), (Topics{"/pose", "/scan"}));
}

TEST(ChooseTopics, AllTakesWhatIsPublished) {
  EXPECT_EQ(choose(SubscribePolicy::kAll),
            (Topics{"/camera/points", "/camera/rect", "/pose", "/scan"}));
}

TEST(ChooseTopics, ModelTakesTheModelsTopicsPublishedOrNot) {
  EXPECT_EQ(choose(SubscribePolicy::kModel), (Topics{"/pose"}));
}

TEST(OwnOutput, IsWhatTheModelDoesNotKnowFromTheProcess) {
  const OwnOutput own("/manager", {"/scan", "/rosout"});
  EXPECT_TRUE(own.covers("/manager", "/watch/status"));
  EXPECT_TRUE(own.covers("/manager", "/rosout"));
  EXPECT_FALSE(own.covers("/manager", "/scan"));
  EXPECT_FALSE(own.covers("/player", "/watch/status"));
}

TEST(ClockWatch, ToleratesSlewAndBusyMoments) {
  ClockWatch watch;
  EXPECT_FALSE(watch.look(1000 * kSecond, 0, false));
  EXPECT_FALSE(watch.look(1001 * kSecond, kSecond + 400 * kMillisecond, false));
  EXPECT_FALSE(watch.look(1061 * kSecond, 61 * kSecond, false));  // a minute without a look
  EXPECT_FALSE(watch.isStale(1000 * kSecond));
}

TEST(ClockWatch, SeesAWallClockThatIsSetEitherWay) {
  for (const std::int64_t step : {-3600 * kSecond, -kSecond, kSecond, 3600 * kSecond}) {
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

TEST(ClockWatch, SeesABagThatLoopsAndASimulationThatIsReset) {
  ClockWatch watch;
  watch.look(110 * kSecond, 0, true);
  EXPECT_TRUE(watch.look(100 * kSecond, 25 * kMillisecond, true));
  EXPECT_TRUE(watch.look(1700000000 * kSecond, 50 * kMillisecond, true));
}

}  // namespace
}  // namespace self_awareness::ros1
