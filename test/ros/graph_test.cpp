// What is said of who publishes and subscribes to what, without a master.

#include "self_awareness/ros/graph.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/named_once.h"
#include "self_awareness/ros/own_output.h"

namespace self_awareness::ros1 {
namespace {

using Publications = std::set<core::SourceGraph::Publication>;

Graph robot() {
  Graph graph;
  graph.topics["/scan"] = {"T", {"/laser"}, {"/slam_4242_1600000000000", "/watch"}};
  graph.topics["/debug"] = {"T", {"/planner"}, {"/rostopic_1_1600000000000", "/rqt_plot"}};
  graph.topics["/markers"] = {"T", {"/planner"}, {"/watch"}};
  graph.topics["/watch/status"] = {"self_awareness/SelfAwareness", {"/watch"}, {"/panel"}};
  graph.topics["/rqt/out"] = {"T", {"/rqt_plot"}, {}};
  return graph;
}

TEST(GraphOfTheRobot, NodesOfThisPackageAreNoPartOfItWhateverTheirNames) {
  const Graph graph = withoutSiblings(robot());
  EXPECT_EQ(graph.topics.at("/scan").subscribers,
            std::set<std::string>{"/slam_4242_1600000000000"});
  EXPECT_TRUE(graph.topics.at("/markers").subscribers.empty());
  EXPECT_TRUE(graph.topics.at("/watch/status").publishers.empty());
  core::SourceGraph edges;
  addEdges(robot(), "/self_awareness", Encoder({}, nullptr), edges);
  EXPECT_TRUE(edges.hears("/slam", "/laser", "/scan"));
  EXPECT_FALSE(edges.hears("/watch", "/laser", "/scan"));
  EXPECT_FALSE(edges.hears("/panel", "/watch", "/watch/status"));
}

TEST(GraphOfTheRobot, WhatOnlyToolsSubscribeToIsUnheard) {
  const Graph graph = withoutSiblings(robot());
  EncodingRules rules = EncodingRules::defaults();
  EXPECT_EQ(unheardIn(graph, Encoder(rules, nullptr)),
            (Publications{{"/planner", "/debug"}, {"/planner", "/markers"}}))
      << "what a tool publishes is no part of the robot either";
  rules.exclude_topics.emplace_back("/markers");
  rules.source = EncodingRules::Source::kNone;
  EXPECT_EQ(unheardIn(graph, Encoder(rules, nullptr)),
            (Publications{{"", "/debug"}, {"", "/rqt/out"}}));
}

TEST(GraphOfTheRobot, WhoRunsAndDoesNotSubscribeIsMissing) {
  using Subscriptions = std::set<core::SourceGraph::Subscription>;
  const Encoder encoder(EncodingRules::defaults(), nullptr);
  EXPECT_EQ(subscriptionsIn(robot(), encoder),
            (Subscriptions{{"/slam", "/scan"}, {"/panel", "/watch/status"}}));
  const Subscriptions expected{{"/slam", "/scan"}, {"/planner", "/scan"}, {"/gone", "/scan"}};
  EXPECT_EQ(missingIn(robot(), encoder, expected), (Subscriptions{{"/planner", "/scan"}}))
      << "who is not there at all is another finding";
  Graph repaired = robot();
  repaired.topics["/scan"].subscribers.insert("/planner");
  EXPECT_TRUE(missingIn(repaired, encoder, expected).empty());
  Graph managed;
  managed.topics["/image"] = {"T", {"/camera"}, {"/manager"}};
  managed.topics["/watch/status"] = {"self_awareness/SelfAwareness", {"/manager"}, {}};
  EXPECT_TRUE(missingIn(managed, encoder, {{"/manager", "/image"}}).empty())
      << "a monitor in a manager of the robot hides no subscription";
}

TEST(GraphOfTheRobot, KnowsOnWhichComputersSourcesRun) {
  EXPECT_EQ(hostIn("http://base:4242/"), "base");
  EXPECT_EQ(hostIn("http://10.0.0.2:1/"), "10.0.0.2");
  EXPECT_EQ(hostIn(""), "");
  Graph graph;
  graph.hosts = {
      {"/laser", "base"}, {"/view_1_1600000000000", "base"}, {"/view_2_1600000000000", "desk"}};
  core::SourceGraph edges;
  addEdges(graph, "/self_awareness", Encoder({}, nullptr), edges);
  EXPECT_EQ(edges.hostOf("/laser"), "base");
  EXPECT_EQ(edges.hostOf("/view"), "") << "it runs on two";
}

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
  const Encoder encoder(EncodingRules(), nullptr);
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
  const OwnOutput manager("/manager", {{"/manager", "/scan"}, {"/manager", "/rosout"}}, plain());
  EXPECT_TRUE(manager.covers("/manager", "/watch/status"));
  EXPECT_TRUE(manager.covers("/manager", "/rosout"));
  EXPECT_FALSE(manager.covers("/manager", "/scan"));
  EXPECT_FALSE(manager.covers("/player", "/watch/status"));
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

TEST(NothingHeard, IsOfARobotThatIsOffAPlayerOrAPublisherThatIsNotHeard) {
  EncodingRules rules;
  rules.exclude_sources = {"/play"};
  const auto why = [&](const Graph& graph, bool unheard = false) {
    return whyNothingIsHeard(graph, Encoder(rules, nullptr), unheard);
  };
  Graph off;
  off.topics["/rosout"] = {"rosgraph_msgs/Log", {"/rosout_agg"}, {}};
  off.topics["/monitor/status"] = {"self_awareness/SelfAwareness", {"/monitor"}, {}};
  off.topics["/diagnostics"] = {"diagnostic_msgs/DiagnosticArray", {"/monitor"}, {}};
  EXPECT_EQ(why(off), "no node of a robot publishes anything");
  Graph played;
  played.topics["/scan"] = {"sensor_msgs/LaserScan", {"/play_1764000000000000000"}, {"/slam"}};
  played.topics["/odom"] = {"nav_msgs/Odometry", {"/play_1764000000000000000"}, {"/slam"}};
  EXPECT_EQ(why(played),
            "/play_1764000000000000000 plays 2 topics; players are left out: use `score BAG` or "
            "`train BAG`, or `source: none` in the encoding");
  Graph robot;
  robot.topics["/scan"] = {"sensor_msgs/LaserScan", {"/lidar"}, {}};
  EXPECT_EQ(why(robot), "nothing is sent on /scan");
  EXPECT_EQ(why(robot, true),
            "no node of the robot subscribes to /scan; launch it with subscribe:=all to listen "
            "all the same");
}

}  // namespace
}  // namespace self_awareness::ros1
