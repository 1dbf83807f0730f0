#include "self_awareness/core/evidence/count/partners.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "self_awareness/core/evidence/count/pair_set.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();

Partner partner(EventId id, std::uint64_t answers, std::uint32_t count) {
  Partner partner;
  partner.id = id;
  partner.answers = answers;
  partner.delays[3] = count;
  return partner;
}

TEST(Partners, KeepCountsOfAnySize) {
  Partners partners;
  const std::vector<std::uint32_t> counts{1, 255, 256, 65535, 65536, kMost, 0};
  for (EventId id = 0; id < counts.size(); ++id) {
    partners.append(partner(2 * id, id, counts[id]));
  }
  ASSERT_EQ(partners.size(), counts.size());
  for (EventId id = 0; id < counts.size(); ++id) {
    EXPECT_TRUE(partners.at(id) == partner(2 * id, id, counts[id]));
    EXPECT_EQ(partners.total(id), counts[id]);
    EXPECT_EQ(partners.answers(id), id);
    EXPECT_EQ(partners.find(2 * id), id);
    EXPECT_FALSE(partners.find(2 * id + 1));
  }
  EXPECT_THROW(partners.append(partner(3, 0, 1)), std::invalid_argument);
  EXPECT_THROW(partners.append(partner(12, 0, 1)), std::invalid_argument);
}

TEST(Partners, CountEventsBeyondAByteAndTwo) {
  constexpr std::uint32_t kEvents = 70000;
  Partners partners;
  partners.makeAll(3);
  for (std::uint32_t k = 0; k < kEvents; ++k) {
    partners.count({7, k < 300 ? std::uint8_t{1} : std::uint8_t{49}, Partners::kNotSeen},
                   {1, 0, 0});
  }
  EXPECT_EQ(partners.at(0).delays[7], kEvents);
  EXPECT_EQ(partners.at(0).answers, kEvents);
  EXPECT_EQ(partners.at(1).delays[1], 300U);
  EXPECT_EQ(partners.at(1).delays[49], kEvents - 300);
  EXPECT_EQ(partners.at(1).answers, 0U);
  EXPECT_EQ(partners.total(2), 0U);
}

TEST(Partners, CountOnAfterSomeWereKeptOnly) {
  Partners partners;
  partners.append(partner(1, 5, 250));
  partners.makeAll(3);
  for (int k = 0; k < 10; ++k) {
    partners.count({3, 3, 3}, {0, 1, 0});
  }
  ASSERT_EQ(partners.size(), 3U);
  EXPECT_TRUE(partners.at(0) == partner(0, 0, 10));
  EXPECT_TRUE(partners.at(1) == partner(1, 15, 260));
  partners.makeAll(5);
  partners.count({3, Partners::kNotSeen, 3, 4}, {1, 2});  // two events, of the first two types
  EXPECT_EQ(partners.at(0).delays[3], 12U);
  EXPECT_EQ(partners.at(1).delays[4], 1U);
  EXPECT_EQ(partners.at(1).answers, 17U);
  EXPECT_THROW(partners.count({3, 3, 3}, {0, 0}), std::invalid_argument);
  EXPECT_EQ(partners.total(4), 0U);
}

TEST(Partners, AddUpAndStayAtTheLargestNumber) {
  Partners a;
  a.append(partner(1, 2, 200));
  a.append(partner(4, 1, kMost - 5));
  Partners b;
  b.append(partner(0, 7, 1));
  b.append(partner(1, 3, 100));
  b.append(partner(4, 1, 10));
  for (const Partners& both : {Partners::sum(a, b), Partners::sum(b, a)}) {
    ASSERT_EQ(both.size(), 3U);
    EXPECT_TRUE(both.at(0) == partner(0, 7, 1));
    EXPECT_TRUE(both.at(1) == partner(1, 5, 300));
    EXPECT_TRUE(both.at(2) == partner(4, 2, kMost));
  }
}

TEST(PairSet, HoldsWhatWasAdded) {
  PairSet pairs;
  EXPECT_TRUE(pairs.empty());
  pairs.add(70, 3);
  pairs.add(2, 90);
  EXPECT_TRUE(pairs.contains(70, 3));
  EXPECT_FALSE(pairs.contains(3, 70));
  EXPECT_FALSE(pairs.contains(500, 500));
  std::vector<EventId> visited;
  pairs.forEach([&](EventId to, EventId from) { visited.insert(visited.end(), {to, from}); });
  EXPECT_EQ(visited, (std::vector<EventId>{2, 90, 70, 3}));
}

}  // namespace
}  // namespace self_awareness::core::evidence
