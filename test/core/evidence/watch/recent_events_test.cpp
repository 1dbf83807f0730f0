#include "core/evidence/watch/recent_events.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace self_awareness::core::evidence {
namespace {

constexpr std::size_t kTypes = 3;

std::vector<std::pair<std::int64_t, EventId>> of(const RecentEvents& events, EventId a,
                                                 EventId b) {
  std::vector<std::pair<std::int64_t, EventId>> found;
  for (const RecentEvents::Remembered& event : events.of(a, b)) {
    found.emplace_back(event.stamp, event.id);
  }
  return found;
}

using Expected = std::vector<std::pair<std::int64_t, EventId>>;

TEST(RecentEvents, AreCountedSinceTheLastOneOfAnotherType) {
  RecentEvents events(kTypes);
  EXPECT_EQ(events.since(0, 1), 0U);
  events.add({10, 0}, false);
  events.add({11, 0}, false);
  EXPECT_EQ(events.since(0, 1), 2U) << "that never came";
  for (const Event& event : std::vector<Event>{{12, 1}, {13, 2}}) {
    events.add(event, false);
  }
  EXPECT_EQ(events.since(0, 1), 0U);
  events.add({14, 0}, false);
  EXPECT_EQ(events.since(0, 1), 1U);
  EXPECT_EQ(events.since(1, 0), 0U);
  EXPECT_EQ(events.since(0, 0), 0U);
}

TEST(RecentEvents, AreTheLastOnesOnly) {
  RecentEvents events(kTypes);
  events.add({1, 1}, false);
  for (std::size_t k = 1; k < RecentEvents::kMost; ++k) {
    events.add({static_cast<std::int64_t>(10 + k), 0}, false);
  }
  ASSERT_EQ(events.of(1, 1).size(), 1U);
  EXPECT_EQ(events.of(0, 1).size(), RecentEvents::kMost);
  events.add({1000000, 0}, false);
  EXPECT_TRUE(events.of(1, 1).empty());
  EXPECT_EQ(events.of(0, 0).size(), RecentEvents::kMost);
  events.add({1000001, 1}, false);
  EXPECT_EQ(of(events, 1, 1), (Expected{{1000001, 1}})) << "the other one is too long ago";
}

}  // namespace
}  // namespace self_awareness::core::evidence
