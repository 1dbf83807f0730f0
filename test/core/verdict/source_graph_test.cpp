#include "self_awareness/core/verdict/source_graph.h"

#include <gtest/gtest.h>

namespace self_awareness::core {
namespace {

TEST(SourceGraph, ReachedSourcesAreDownstream) {
  SourceGraph graph;
  EXPECT_TRUE(graph.empty());
  graph.connect("/laser", "/slam");
  graph.connect("/slam", "/navigation");
  EXPECT_FALSE(graph.empty());
  EXPECT_TRUE(graph.isUpstream("/laser", "/slam"));
  EXPECT_TRUE(graph.isUpstream("/laser", "/navigation"));
  EXPECT_FALSE(graph.isUpstream("/navigation", "/laser"));
  EXPECT_FALSE(graph.isUpstream("/slam", "/laser"));
}

TEST(SourceGraph, UnconnectedSourcesAreNeither) {
  SourceGraph graph;
  graph.connect("/laser", "/slam");
  graph.connect("/camera", "/faces");
  EXPECT_FALSE(graph.isUpstream("/laser", "/faces"));
  EXPECT_FALSE(graph.isUpstream("/faces", "/laser"));
  EXPECT_FALSE(graph.isUpstream("/laser", "/nobody"));
  EXPECT_FALSE(graph.isUpstream("/nobody", "/laser"));
}

TEST(SourceGraph, NoSourceIsUpstreamOfItself) {
  SourceGraph graph;
  graph.connect("/motors", "/motors");
  EXPECT_FALSE(graph.isUpstream("/motors", "/motors"));
}

TEST(SourceGraph, InALoopTheShorterWayDecides) {
  SourceGraph graph;
  graph.connect("/laser", "/slam");
  graph.connect("/slam", "/navigation");
  graph.connect("/navigation", "/laser");
  EXPECT_TRUE(graph.isUpstream("/laser", "/slam"));
  EXPECT_FALSE(graph.isUpstream("/slam", "/laser"));
  EXPECT_TRUE(graph.isUpstream("/navigation", "/laser"));
  EXPECT_FALSE(graph.isUpstream("/laser", "/navigation"));  // two steps there, one back
}

TEST(SourceGraph, SourcesThatTalkToEachOtherAreNeither) {
  SourceGraph graph;
  graph.connect("/motors", "/control");
  graph.connect("/control", "/motors");
  EXPECT_FALSE(graph.isUpstream("/motors", "/control"));
  EXPECT_FALSE(graph.isUpstream("/control", "/motors"));
}

TEST(SourceGraph, ALoopBesideTheWayIsWalkedOnce) {
  SourceGraph graph;
  graph.connect("/a", "/b");
  graph.connect("/b", "/a");
  graph.connect("/b", "/c");
  EXPECT_TRUE(graph.isUpstream("/a", "/c"));
  EXPECT_FALSE(graph.isUpstream("/c", "/a"));
}

}  // namespace
}  // namespace self_awareness::core
