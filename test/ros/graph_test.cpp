#include "self_awareness/ros/graph.h"

#include <gtest/gtest.h>

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
}

TEST(GraphOfTheRobot, AMonitorInAManagerOfTheRobotHidesNoSubscription) {
  Graph graph;
  graph.topics["/image"] = {"T", {"/camera"}, {"/manager"}};
  graph.topics["/watch/status"] = {"self_awareness/SelfAwareness", {"/manager"}, {}};
  const Encoder encoder(EncodingRules::defaults(), nullptr);
  EXPECT_TRUE(missingIn(graph, encoder, {{"/manager", "/image"}}).empty());
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

}  // namespace
}  // namespace self_awareness::ros1
