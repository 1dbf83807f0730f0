#include "self_awareness/core/verdict/dependents.h"

#include <gtest/gtest.h>

namespace self_awareness::core {
namespace {

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

}  // namespace
}  // namespace self_awareness::core
