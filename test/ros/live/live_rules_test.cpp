// What the live side decides without a master: which topics, what its own output is, and when the
// clock was set.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <set>
#include <string>
#include <vector>

#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/live/clock_watch.h"
#include "self_awareness/ros/live/lost_publishers.h"
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

TEST(OwnOutput, LeavesOutWhatOtherNodesOfThePackageSayOfThemselves) {
  OwnOutput own("/watch", {{"/base", "/rosout"}});
  Graph graph;
  graph.topics["/second/status"] = {"self_awareness/SelfAwareness", {"/second", "/base"}, {}};
  graph.topics["/scan"] = {"sensor_msgs/LaserScan", {"/player"}, {}};
  EXPECT_FALSE(own.covers("/second", "/rosout"));
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

constexpr char kUri[] = "http://robot:4711/";

class LostPublishersTest : public testing::Test {
 protected:
  /// Looks at a node with two topics, and at another one that is connected all the time.
  Topics look(bool connected, std::int64_t second) {
    return lost_.look({{kUri, "/scan", connected},
                       {kUri, "/rare", connected},
                       {"http://robot:1/", "/scan", true}},
                      second * kSecond);
  }

  Reached reached_ = Reached::kYes;
  int asked_ = 0;
  LostPublishers lost_{[this](const std::string& uri) {
    ++asked_;
    EXPECT_EQ(uri, kUri);
    return reached_;
  }};
};

TEST_F(LostPublishersTest, ConnectsAgainToTheTopicsOfANodeThatLives) {
  EXPECT_EQ(look(true, 0), Topics());
  EXPECT_EQ(look(true, 1), Topics());
  EXPECT_EQ(asked_, 0);
  reached_ = Reached::kRefused;
  EXPECT_EQ(look(false, 2), Topics());
  EXPECT_EQ(look(false, 3), Topics());
  EXPECT_EQ(look(false, 4), Topics());
  EXPECT_EQ(asked_, 3);
  reached_ = Reached::kYes;
  EXPECT_EQ(look(false, 5), (Topics{"/rare", "/scan"}));
  EXPECT_EQ(look(true, 6), Topics());
  EXPECT_EQ(look(true, 7), Topics());
  EXPECT_EQ(asked_, 4);
}

TEST_F(LostPublishersTest, NoticesWhoDiedBeforeTheFirstLook) {
  EXPECT_EQ(look(false, 0), Topics()) << "they may be connecting";
  EXPECT_EQ(look(false, 1), (Topics{"/rare", "/scan"}));
}

TEST_F(LostPublishersTest, LeavesAloneWhatRoscppHasGivenUp) {
  look(true, 0);
  reached_ = Reached::kRefused;
  look(false, 1);
  reached_ = Reached::kYes;
  EXPECT_EQ(lost_.look({}, 2 * kSecond), Topics());
  EXPECT_EQ(look(true, 3), Topics());
  EXPECT_EQ(asked_, 1);
}

TEST_F(LostPublishersTest, LeavesAloneWhatRoscppHasConnectedAgain) {
  look(true, 0);
  reached_ = Reached::kRefused;
  look(false, 1);
  reached_ = Reached::kYes;
  EXPECT_EQ(look(true, 2), Topics());
  EXPECT_EQ(asked_, 1);
}

TEST_F(LostPublishersTest, AsksAgainWhereTheNodeDidNotKnowItsTopicYet) {
  look(true, 0);
  look(false, 1);  // asked for both
  const Link rare{kUri, "/rare", true};
  const Link scan{kUri, "/scan", true};
  EXPECT_EQ(lost_.look({rare}, 2 * kSecond), Topics{"/scan"});
  EXPECT_EQ(lost_.look({rare, scan}, 4 * kSecond), Topics());
  EXPECT_EQ(lost_.look({rare, scan}, 9 * kSecond), Topics());
  EXPECT_EQ(asked_, 2);
}

TEST_F(LostPublishersTest, GivesUpWhoDoesNotPublishAnyMore) {
  look(true, 0);
  look(false, 1);
  for (int second = 2; second < 1000; ++second) {
    lost_.look({}, second * kSecond);
    reached_ = second % 2 == 0 ? Reached::kYes : Reached::kRefused;
  }
  EXPECT_GT(asked_, 4);
  EXPECT_LT(asked_, 10);
}

TEST_F(LostPublishersTest, WhoComesAndGoesDoesNotDisturbOthersAllTheTime) {
  int renewed = 0;
  for (int second = 0; second < 600; ++second) {
    renewed += look(second % 2 == 0, second).empty() ? 0 : 1;
  }
  EXPECT_GT(renewed, 2);
  EXPECT_LT(renewed, 20);
}

TEST_F(LostPublishersTest, AMachineThatIsOffIsAskedLessAndLess) {
  look(true, 0);
  reached_ = Reached::kNoAnswer;
  for (int second = 1; second < 600; ++second) {
    look(false, second);
  }
  EXPECT_LT(asked_, 20);
  reached_ = Reached::kYes;
  Topics again;
  for (int second = 600; second < 700; ++second) {
    again.merge(look(false, second));
  }
  EXPECT_EQ(again, (Topics{"/rare", "/scan"}));
}

TEST(LostPublishers, AConnectionStandsAsLongAsItsSocketIsTheSame) {
  const int server = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  ASSERT_EQ(bind(server, any, size), 0);
  ASSERT_EQ(listen(server, 1), 0);
  ASSERT_EQ(getsockname(server, any, &size), 0);
  const int client = socket(AF_INET, SOCK_STREAM, 0);
  ASSERT_EQ(connect(client, any, size), 0);
  ASSERT_EQ(getsockname(client, any, &size), 0);
  const auto describe = [&](int port) {
    return "TCPROS connection on port " + std::to_string(port) + " to [robot:4711 on socket " +
           std::to_string(client) + "]";
  };
  const int port = ntohs(address.sin_port);
  EXPECT_TRUE(isConnected(describe(port)));
  EXPECT_FALSE(isConnected(describe(port == 1 ? 2 : 1))) << "the socket is another one";
  close(client);
  EXPECT_FALSE(isConnected(describe(port)));
  EXPECT_TRUE(isConnected("another transport")) << "nothing is known of it";
  close(server);
}

TEST(OwnOutput, IsWhatTheModelDoesNotKnowFromTheProcess) {
  const OwnOutput own("/manager", {{"/manager", "/scan"}, {"/manager", "/rosout"}});
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
