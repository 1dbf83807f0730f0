// What the live side decides without a master: which topics, and what its own output is.

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/named_once.h"
#include "self_awareness/ros/own_output.h"

namespace self_awareness::ros1 {
namespace {

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

TEST(ChooseTopics, UsedLeavesLazyPublishersAsleepAllDoesNotAndModelTakesTheModelsOnly) {
  EXPECT_EQ(choose(SubscribePolicy::kUsed), (Topics{"/pose", "/scan"}));
  EXPECT_EQ(choose(SubscribePolicy::kAll),
            (Topics{"/camera/points", "/camera/rect", "/pose", "/scan"}));
  EXPECT_EQ(choose(SubscribePolicy::kModel), (Topics{"/pose"})) << "published or not";
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

}  // namespace
}  // namespace self_awareness::ros1
