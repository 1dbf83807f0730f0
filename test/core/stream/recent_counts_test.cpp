#include "self_awareness/core/stream/recent_counts.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace self_awareness::core {
namespace {

TEST(RecentCounts, SlideOverTheLastWindows) {
  RecentCounts recent(1, 2);
  recent.add(0);
  recent.close();
  EXPECT_FALSE(recent.full());
  recent.add(0);
  recent.add(0);
  recent.close();
  EXPECT_TRUE(recent.full());
  EXPECT_EQ(recent.counts(), std::vector<std::uint32_t>{3});
  recent.resize(2);
  recent.add(1);
  recent.close();
  EXPECT_EQ(recent.counts(), (std::vector<std::uint32_t>{2, 1}));
  recent.restart();
  EXPECT_FALSE(recent.full());
  recent.close();
  recent.close();
  EXPECT_EQ(recent.counts(), (std::vector<std::uint32_t>{0, 0}));
}

}  // namespace
}  // namespace self_awareness::core
