// What the live side decides without a master: which topics, what its own output is, and when the
// clock was set.

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/live/clock_watch.h"
#include "self_awareness/ros/live/named_once.h"
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
      [](const std::string& node) { return node != "/self_awareness"; });
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

TEST(ChooseTopics, LeavesOutWhatRoscppCannotSubscribeTo) {
  Graph graph;
  const std::string longest = "/" + std::string(kLongestName - 1, 'a');
  for (const std::string& name : {std::string("/foo-bar"), std::string("/a b"),
                                  std::string("/x:y"), std::string("/\xc3\xbc"), std::string("~x"),
                                  std::string(), longest + "a", longest, std::string("/a_1/B")}) {
    graph.topics[name] = {"std_msgs/String", {"/anybody"}, {"/other"}};
  }
  const Encoder encoder(EncodingRules(), [](const core::EventType& /*type*/) { return 0; });
  EXPECT_EQ(chooseTopics(
                graph, SubscribePolicy::kAll, {"/scan-front", "/scan"},
                [&](const std::string& topic) { return encoder.includesTopic(topic); },
                [&](const std::string& node) { return encoder.listens(node); }),
            (Topics{"/a_1/B", longest, "/scan"}));
}

std::shared_ptr<const Encoder> plain() {
  return std::make_shared<const Encoder>(EncodingRules(), nullptr);
}

TEST(OwnOutput, LeavesOutWhatOtherNodesOfThePackageSayOfThemselves) {
  OwnOutput own("/watch", {{"/base", "/rosout"}}, plain());
  Graph graph;
  graph.topics["/second/status"] = {"self_awareness/SelfAwareness", {"/second", "/base"}, {}};
  graph.topics["/scan"] = {"sensor_msgs/LaserScan", {"/player"}, {}};
  EXPECT_FALSE(own.covers("/second", "/rosout"));
  EXPECT_TRUE(own.mayCover("/second", "/rosout"));
  EXPECT_FALSE(own.mayCover("/second", "/scan"));
  EXPECT_FALSE(own.mayCover("/base", "/rosout")) << "the model knows it";
  EXPECT_TRUE(own.setGraph(graph));
  EXPECT_FALSE(own.setGraph(graph));
  EXPECT_TRUE(own.covers("/second", "/rosout"));
  EXPECT_TRUE(own.covers("/second", "/diagnostics"));
  EXPECT_FALSE(own.covers("/second", "/scan"));
  EXPECT_FALSE(own.covers("/player", "/rosout"));
  EXPECT_FALSE(own.covers("/base", "/rosout")) << "the model knows it";
  EXPECT_TRUE(own.covers("/base", "/diagnostics"));
}

TEST(NamedOnce, NamesEachOnceAndNotTooMany) {
  NamedOnce named;
  EXPECT_TRUE(named.add("/a"));
  EXPECT_FALSE(named.add("/a"));
  std::size_t count = 1;
  for (int i = 0; i < 1000; ++i) {
    count += named.add("/b" + std::to_string(i)) ? 1 : 0;
  }
  EXPECT_EQ(count, NamedOnce::kMost);
}

TEST(OwnOutput, IsWhatTheModelDoesNotKnowFromTheProcess) {
  const OwnOutput own("/manager", {{"/manager", "/scan"}, {"/manager", "/rosout"}}, plain());
  EXPECT_TRUE(own.covers("/manager", "/watch/status"));
  EXPECT_TRUE(own.covers("/manager", "/rosout"));
  EXPECT_FALSE(own.covers("/manager", "/scan"));
  EXPECT_FALSE(own.covers("/player", "/watch/status"));
}

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
}  // namespace self_awareness::ros1
