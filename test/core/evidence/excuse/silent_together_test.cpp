#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "stopped.h"

namespace self_awareness::core::evidence {
namespace {

// Two fast ones and a slow one on one computer, two fast ones on another.
const std::vector<EventType> kRobot{{"/laser", "/scan", "T"},
                                    {"/imu", "/imu/data", "T"},
                                    {"/battery", "/charge", "T"},
                                    {"/camera", "/image", "T"},
                                    {"/faces", "/people", "T"}};
constexpr EventId kBattery = 2;

Events robot(std::int64_t start, unsigned seed) {
  Events events;
  for (EventId id = 0; id < kRobot.size(); ++id) {
    const std::int64_t gap = (id == kBattery ? 1000 : 100) * kMillisecond;
    events = together({events, irregular(id, start, start + kEnd, gap, seed + id)});
  }
  return events;
}

class SilentTogetherTest : public StoppedTest {
 protected:
  SilentTogetherTest() : StoppedTest(kRobot) {
    for (const std::string source : {"/laser", "/imu", "/battery"}) {
      graph_->place(source, "base");
    }
    graph_->place("/camera", "head");
    graph_->place("/faces", "head");
    learn(robot);
  }
  std::optional<Silent> find(const std::vector<std::int64_t>& ages, double share = 2) {
    beginAnew();
    return found(ages, kEnd, share).silent;
  }
};

TEST_F(SilentTogetherTest, AComputerOfWhichNobodyIsHeardIsFound) {
  const std::optional<Silent> silent = find({kAgo, kAgo + 1, kAgo + kSecond, 0, 0});
  ASSERT_TRUE(silent);
  EXPECT_EQ(silent->hosts, Strings{"base"});
  EXPECT_EQ(silent->components, (Strings{"/battery", "/imu", "/laser"}));
  EXPECT_EQ(silent->since, kEnd - kAgo);
}

TEST_F(SilentTogetherTest, ItIsNotFoundWhereOneOfItsNodesIsHeard) {
  EXPECT_FALSE(find({kAgo, kAgo, 0, 0, 0}));
  EXPECT_FALSE(find({kAgo, kAgo, kSecond, 0, 0})) << "the slow one may yet come";
  EXPECT_FALSE(find({kAgo, kAgo, kAgo, 0, 0}, 0.5)) << "far from their limits, they prove nothing";
  moment_->strangers["/new"] = kSecond;
  graph_->place("/new", "base");
  EXPECT_FALSE(find({kAgo, kAgo, kAgo, 0, 0}))
      << "somebody there is heard whom the model does not know";
}

TEST_F(SilentTogetherTest, WhoFellSilentLongBeforeTheOthersDidNotDoSoWithThem) {
  const std::optional<Silent> on_host = find({2 * kAgo, kAgo, kAgo, 0, 0});
  ASSERT_TRUE(on_host);
  EXPECT_EQ(on_host->components, (Strings{"/battery", "/imu"}));
  for (const bool before : {true, false}) {
    const std::optional<Silent> all = find({before ? 2 * kAgo : kAgo, kAgo, kAgo, kAgo, kAgo});
    ASSERT_TRUE(all);
    EXPECT_TRUE(all->hosts.empty()) << "nobody is heard";
    EXPECT_EQ(all->components.size(), before ? 4U : 5U);
    EXPECT_NE(all->has("/laser"), before);
  }
}

TEST_F(SilentTogetherTest, AMomentWithoutTheOthersTakesNobodysDeathAway) {
  EXPECT_FALSE(find({kAgo, 5 * kSecond, 5 * kSecond, 5 * kSecond, 5 * kSecond}, 0.5))
      << "a silence that is rare, and far from any limit";
  for (const EventType& type : kRobot) {
    graph_->place(type.source, "");
  }
  EXPECT_FALSE(find({kAgo, kAgo, kAgo, kAgo, 2 * kSecond})) << "one alone";
}

TEST_F(SilentTogetherTest, WithoutComputersOnlyAllAreSilentTogether) {
  for (const EventType& type : kRobot) {
    graph_->place(type.source, "");
  }
  EXPECT_FALSE(find({kAgo, kAgo, kAgo, 0, 0}));
  EXPECT_TRUE(find({kAgo, kAgo, kAgo, kAgo, kAgo}));
  for (const EventType& type : kRobot) {
    graph_->place(type.source, "base");
  }
  EXPECT_FALSE(find({kAgo, kAgo, kAgo, 0, 0})) << "all run on one";
}

TEST_F(SilentTogetherTest, SeveralComputersAreNamedTogether) {
  graph_->place("/battery", "dock");
  const std::optional<Silent> silent = find({kAgo, kAgo, 0, kAgo, kAgo});
  ASSERT_TRUE(silent);
  EXPECT_EQ(silent->hosts, (Strings{"base", "head"}));
  EXPECT_EQ(describe(*silent), "everything on hosts base and head fell silent: 4 nodes");
}

}  // namespace
}  // namespace self_awareness::core::evidence
