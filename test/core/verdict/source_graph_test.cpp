#include "self_awareness/core/verdict/source_graph.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "self_awareness/core/verdict/dependents.h"

namespace self_awareness::core {
namespace {

TEST(SourceGraph, KnowsTheComputersOfSources) {
  SourceGraph graph;
  EXPECT_EQ(graph.hostOf("/laser"), "");
  graph.place("/laser", "base");
  graph.place("/laser", "head");
  EXPECT_EQ(graph.hostOf("/laser"), "head") << "it runs there now";
}

TEST(SourceGraph, HearsWhatItSubscribesToOfWhoPublishesIt) {
  SourceGraph graph;
  graph.connect("/laser", "/scan", "/slam");
  graph.connect("/laser", "/status", "/log");
  graph.connect("/camera", "/points", "/slam");
  EXPECT_TRUE(graph.hears("/slam", "/laser", "/scan"));
  EXPECT_TRUE(graph.hears("/log", "/laser", "/status"));
  EXPECT_FALSE(graph.hears("/laser", "/slam", "/scan"));    // the other way round
  EXPECT_FALSE(graph.hears("/slam", "/laser", "/status"));  // another topic of the same two
  EXPECT_FALSE(graph.hears("/slam", "/camera", "/scan"));   // the topic of another publisher
  EXPECT_FALSE(graph.hears("/slam", "/laser", "/nothing"));
}

TEST(SourceGraph, UpstreamIsWhoseMessagesReachAnotherInFewerStepsThanTheOtherWayRound) {
  const std::vector<std::string> names{"/e", "/a", "/b", "/c", "/alone", "/d"};
  SourceGraph graph;
  EXPECT_TRUE(graph.empty());
  graph.connect("/a", "/1", "/b");
  graph.connect("/b", "/2", "/not named");
  graph.connect("/not named", "/3", "/c");
  graph.connect("/c", "/4", "/a");
  graph.connect("/c", "/5", "/d");
  graph.connect("/d", "/6", "/d");
  graph.connect("/e", "/7", "/b");
  EXPECT_FALSE(graph.empty());
  const std::set<std::pair<std::string, std::string>> expected{
      {"/a", "/b"}, {"/c", "/a"}, {"/a", "/d"}, {"/b", "/d"}, {"/c", "/d"},
      {"/e", "/a"}, {"/e", "/b"}, {"/e", "/c"}, {"/e", "/d"}};  // /b and /c: two either way
  const std::vector<std::vector<bool>> upstream = graph.upstream(names);
  for (std::size_t from = 0; from < names.size(); ++from) {
    for (std::size_t to = 0; to < names.size(); ++to) {
      EXPECT_EQ(upstream[from][to], expected.count({names[from], names[to]}) > 0)
          << names[from] << " " << names[to];
    }
  }
}

using Names = std::set<std::string>;

TEST(DependentsOf, WhoIsReachedByMessagesNeedsThem) {
  SourceGraph graph;
  graph.connect("/a", "/x", "/b");
  graph.connect("/b", "/y", "/c");
  graph.connect("/c", "/z", "/b");
  graph.connect("/b", "/rosout", "/d");
  EXPECT_EQ(dependentsOf(graph, "/b"), (Names{"/b", "/c"})) << "a loop leads back";
  EXPECT_EQ(dependentsOf(graph, "/a"), (Names{"/b", "/c"})) << "nobody needs a log";
  EXPECT_EQ(dependentsOf(graph, "/d"), Names{});
}

TEST(WaitingFor, TheLongestWayIsToldFromItsEnd) {
  SourceGraph graph;
  graph.connect("/lidar", "/scan", "/filter");
  graph.connect("/lidar", "/scan", "/safety");
  graph.connect("/filter", "/filtered", "/costmap");
  graph.connect("/costmap", "/costs", "/lidar");
  graph.connect("/lidar", "/rosout", "/log");
  EXPECT_EQ(waitingFor(graph, "/lidar", {"/costmap", "/filter", "/lidar", "/log"}),
            "/costmap waits for /filter, /filter for /lidar");
  EXPECT_EQ(waitingFor(graph, "/lidar", {"/costmap", "/filter", "/safety"}),
            "/costmap waits for /filter, /filter for /lidar (3 nodes wait in all)");
  EXPECT_EQ(waitingFor(graph, "/lidar", {"/safety"}), "/safety waits for /lidar");
  EXPECT_EQ(waitingFor(graph, "/lidar", {"/costmap"}), "") << "what it waits for goes on";
}

}  // namespace
}  // namespace self_awareness::core
