#include "core/evidence/blame/root_first.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace self_awareness::core::evidence {
namespace {

using Upstream = std::set<std::pair<std::string, std::string>>;

std::vector<std::string> ordered(const std::vector<std::string>& components,
                                 const Upstream& upstream) {
  std::vector<std::string> names;
  for (const std::size_t index :
       rootFirst(components, [&](const std::string&source, const std::string&other) {
         return upstream.count({source, other}) > 0;
       })) {
    names.push_back(components.at(index));
  }
  return names;
}

using Names = std::vector<std::string>;

TEST(RootFirst, WithoutAnyRelationTheLikeliestComesFirst) {
  EXPECT_EQ(ordered({"/c", "/a", "/b"}, {}), (Names{"/c", "/a", "/b"}));
  EXPECT_TRUE(ordered({}, {}).empty());
}

TEST(RootFirst, RootsComeBeforeTheirVictims) {
  const Upstream chain{{"/a", "/b"}, {"/b", "/c"}, {"/a", "/c"}};
  EXPECT_EQ(ordered({"/c", "/b", "/a"}, chain), (Names{"/a", "/b", "/c"}));
  EXPECT_EQ(ordered({"/c", "/d", "/b"}, chain), (Names{"/d", "/b", "/c"}))
      << "who has nothing upstream is next";
}

TEST(RootFirst, InALoopTheLikelierComesFirst) {
  const Upstream loop{{"/a", "/b"}, {"/b", "/a"}};
  EXPECT_EQ(ordered({"/b", "/a"}, loop), (Names{"/b", "/a"}));
  EXPECT_EQ(ordered({"/a", "/b"}, loop), (Names{"/a", "/b"}));
}

TEST(RootFirst, AComponentMayComeTwice) {
  EXPECT_EQ(ordered({"/b", "/a", "/b"}, {{"/a", "/b"}}), (Names{"/a", "/b", "/b"}));
}

}  // namespace
}  // namespace self_awareness::core::evidence
