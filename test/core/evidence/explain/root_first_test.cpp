#include "core/evidence/explain/root_first.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

namespace self_awareness::core::evidence {
namespace {

constexpr std::size_t kA = 0;
constexpr std::size_t kB = 1;
constexpr std::size_t kC = 2;
constexpr std::size_t kD = 3;

using Components = std::vector<std::size_t>;
using Pairs = std::set<std::pair<std::size_t, std::size_t>>;

Components ordered(const Components& components, const Pairs& roots) {
  Components roots_first;
  for (const std::size_t place :
       rootFirst(components.size(), [&](std::size_t root, std::size_t victim) {
         return roots.count({components[root], components[victim]}) > 0;
       })) {
    roots_first.push_back(components.at(place));
  }
  return roots_first;
}

TEST(RootFirst, RootsComeBeforeTheirVictims) {
  const Pairs chain{{kA, kB}, {kB, kC}, {kA, kC}};
  EXPECT_EQ(ordered({kC, kB, kA}, chain), (Components{kA, kB, kC}));
  EXPECT_EQ(ordered({kC, kD, kB}, chain), (Components{kD, kB, kC}))
      << "who has nothing upstream is next";
}

TEST(RootFirst, AComponentMayComeTwice) {
  EXPECT_EQ(ordered({kB, kA, kB}, {{kA, kB}}), (Components{kA, kB, kB}));
}

}  // namespace
}  // namespace self_awareness::core::evidence
