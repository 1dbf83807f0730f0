#include "self_awareness/core/verdict/source_graph.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace self_awareness::core {
namespace {

bool isUpstream(const SourceGraph& graph, const std::string& from, const std::string& to) {
  return graph.upstream({from, to})[0][1];
}

TEST(SourceGraph, ReachedSourcesAreDownstream) {
  SourceGraph graph;
  EXPECT_TRUE(graph.empty());
  graph.connect("/laser", "/laser/out", "/slam");
  graph.connect("/slam", "/slam/out", "/navigation");
  EXPECT_FALSE(graph.empty());
  EXPECT_TRUE(isUpstream(graph, "/laser", "/slam"));
  EXPECT_TRUE(isUpstream(graph, "/laser", "/navigation"));
  EXPECT_FALSE(isUpstream(graph, "/navigation", "/laser"));
  EXPECT_FALSE(isUpstream(graph, "/slam", "/laser"));
}

TEST(SourceGraph, KnowsTheComputersOfSources) {
  SourceGraph graph;
  EXPECT_EQ(graph.hostOf("/laser"), "");
  graph.place("/laser", "base");
  graph.place("/laser", "head");
  EXPECT_EQ(graph.hostOf("/laser"), "head") << "it runs there now";
}

TEST(SourceGraph, UnconnectedSourcesAreNeither) {
  SourceGraph graph;
  graph.connect("/laser", "/laser/out", "/slam");
  graph.connect("/camera", "/camera/out", "/faces");
  EXPECT_FALSE(isUpstream(graph, "/laser", "/faces"));
  EXPECT_FALSE(isUpstream(graph, "/faces", "/laser"));
  EXPECT_FALSE(isUpstream(graph, "/laser", "/nobody"));
  EXPECT_FALSE(isUpstream(graph, "/nobody", "/laser"));
}

TEST(SourceGraph, NoSourceIsUpstreamOfItself) {
  SourceGraph graph;
  graph.connect("/motors", "/motors/out", "/motors");
  EXPECT_FALSE(graph.upstream({"/motors"})[0][0]);
}

TEST(SourceGraph, InALoopTheShorterWayDecides) {
  SourceGraph graph;
  graph.connect("/laser", "/laser/out", "/slam");
  graph.connect("/slam", "/slam/out", "/navigation");
  graph.connect("/navigation", "/navigation/out", "/laser");
  EXPECT_TRUE(isUpstream(graph, "/laser", "/slam"));
  EXPECT_FALSE(isUpstream(graph, "/slam", "/laser"));
  EXPECT_TRUE(isUpstream(graph, "/navigation", "/laser"));
  EXPECT_FALSE(isUpstream(graph, "/laser", "/navigation"));  // two steps there, one back
}

TEST(SourceGraph, SourcesThatTalkToEachOtherAreNeither) {
  SourceGraph graph;
  graph.connect("/motors", "/motors/out", "/control");
  graph.connect("/control", "/control/out", "/motors");
  EXPECT_FALSE(isUpstream(graph, "/motors", "/control"));
  EXPECT_FALSE(isUpstream(graph, "/control", "/motors"));
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

TEST(SourceGraph, ALoopBesideTheWayIsWalkedOnce) {
  SourceGraph graph;
  graph.connect("/a", "/a/out", "/b");
  graph.connect("/b", "/b/out", "/a");
  graph.connect("/b", "/b/out", "/c");
  EXPECT_TRUE(isUpstream(graph, "/a", "/c"));
  EXPECT_FALSE(isUpstream(graph, "/c", "/a"));
}

TEST(SourceGraph, KnowsOfManyAtOnceWhoIsUpstream) {
  const std::vector<std::string> names{"/e", "/a", "/b", "/c", "/alone", "/d"};
  SourceGraph graph;
  graph.connect("/a", "/1", "/b");
  graph.connect("/b", "/2", "/not named");
  graph.connect("/not named", "/3", "/c");
  graph.connect("/c", "/4", "/a");
  graph.connect("/c", "/5", "/d");
  graph.connect("/d", "/6", "/d");
  graph.connect("/e", "/7", "/b");
  const std::set<std::pair<std::string, std::string>> expected{
      {"/a", "/b"}, {"/c", "/a"}, {"/a", "/d"}, {"/b", "/d"}, {"/c", "/d"},
      {"/e", "/a"}, {"/e", "/b"}, {"/e", "/c"}, {"/e", "/d"}};
  const std::vector<std::vector<bool>> upstream = graph.upstream(names);
  for (std::size_t from = 0; from < names.size(); ++from) {
    for (std::size_t to = 0; to < names.size(); ++to) {
      EXPECT_EQ(upstream[from][to], expected.count({names[from], names[to]}) > 0)
          << names[from] << " " << names[to];
    }
  }
}

}  // namespace
}  // namespace self_awareness::core
