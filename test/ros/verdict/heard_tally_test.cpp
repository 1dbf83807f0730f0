#include "ros/verdict/heard_tally.h"

#include <gtest/gtest.h>

#include "../../times.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::int64_t kSteady = 5000 * kSecond;  // steady time at the start
const std::vector<core::EventType> kTypes = {{"/player", "/scan", "T"},
                                             {"/slam", "/pose", "T"},
                                             {"/player", "/odom", "T"},
                                             {"", "/replayed", "T"}};

class HeardTallyTest : public testing::Test {
 protected:
  HeardTallyTest() { tally_.setTypes(kTypes); }

  HeardReport report(double seconds, std::uint64_t dropped = 0) {
    const auto later = static_cast<std::int64_t>(seconds * kSecond);
    return tally_.report({kStart + later, kSteady + later, cpu_}, dropped);
  }

  std::int64_t cpu_ = 7 * kSecond;  // processor time of the process
  HeardTally tally_{{kStart, kSteady, cpu_}};
};

TEST_F(HeardTallyTest, CountsByComponent) {
  for (int i = 0; i < 6; ++i) {
    tally_.add({kStart + i * kSecond / 10, static_cast<core::EventId>(i % 3)});
  }
  const HeardReport heard = report(2);
  ASSERT_EQ(heard.components.size(), 3U);
  EXPECT_DOUBLE_EQ(heard.components.at("/player").rate, 2);
  EXPECT_DOUBLE_EQ(heard.components.at("/player").last_heard.value(), 1.5);
  EXPECT_DOUBLE_EQ(heard.components.at("/slam").rate, 1);
  EXPECT_DOUBLE_EQ(heard.components.at("/slam").last_heard.value(), 1.6);
  EXPECT_EQ(heard.components.at("/replayed").last_heard, std::nullopt);
  EXPECT_DOUBLE_EQ(heard.rate, 3);
  tally_.add({kStart, 0});
  tally_.setTypes({{"/base", "/odom", "T"}});
  EXPECT_DOUBLE_EQ(report(3).rate, 1) << "of the monitor as a whole";
  tally_.add({kStart, 4});
  const HeardReport unknown = report(3);
  EXPECT_DOUBLE_EQ(unknown.rate, 1000) << "at the same moment: within 1 ms at least";
  ASSERT_EQ(unknown.components.size(), 1U) << "another model has other components";
  EXPECT_EQ(unknown.components.at("/base").rate, 0);
  EXPECT_EQ(unknown.components.at("/base").last_heard, std::nullopt);
}

TEST_F(HeardTallyTest, CountsTheEventTypesThatTheModelKnowsAndTheOthers) {
  for (const core::EventId id : {0U, 0U, 2U, 4U, 9U, 9U}) {
    tally_.add({kStart, id});
  }
  report(1);
  tally_.add({kStart, 0});
  tally_.add({kStart, 5});
  const HeardReport heard = report(2);
  EXPECT_EQ(heard.known_types, 2U);
  EXPECT_EQ(heard.unknown_types, 3U);
  tally_.setTypes(kTypes);
  EXPECT_EQ(report(3).known_types + report(3).unknown_types, 0U);
}

TEST_F(HeardTallyTest, EachReportCountsFromTheOneBefore) {
  tally_.add({kStart, 0});
  cpu_ += kSecond / 2;
  const HeardReport first = report(1, 5);
  EXPECT_DOUBLE_EQ(first.cpu_share, 0.5);
  EXPECT_EQ(first.dropped, 5U);
  EXPECT_EQ(first.newly_dropped, 5U);
  EXPECT_DOUBLE_EQ(tally_.sinceReport(kSteady + 4 * kSecond), 3);

  const HeardReport second = report(3, 7);
  EXPECT_EQ(second.rate, 0);
  EXPECT_EQ(second.components.at("/player").rate, 0);
  EXPECT_DOUBLE_EQ(second.components.at("/player").last_heard.value(), 3);
  EXPECT_EQ(second.cpu_share, 0);
  EXPECT_EQ(second.dropped, 7U);
  EXPECT_EQ(second.newly_dropped, 2U);
}

TEST_F(HeardTallyTest, AClockStepForgetsWhenEachWasHeard) {
  tally_.add({kStart, 0});
  tally_.onClockStep();
  const HeardReport heard = report(1);
  EXPECT_EQ(heard.components.at("/player").last_heard, std::nullopt);
  EXPECT_DOUBLE_EQ(heard.components.at("/player").rate, 1) << "it was heard all the same";
  EXPECT_EQ(heard.clock_steps, 1U);
  EXPECT_EQ(report(2).clock_steps, 1U) << "since the start";
}

TEST_F(HeardTallyTest, RatesOfTopicsAreOfTheLastTenToTwentySeconds) {
  for (int second = 1; second <= 25; ++second) {
    for (int i = 0; i < (second <= 10 ? 4 : 2); ++i) {
      tally_.add({kStart, 0});
    }
    tally_.add({kStart, 2});
    const HeardReport heard = report(second);
    EXPECT_DOUBLE_EQ(heard.components.at("/player").rates.at("/odom"), 1) << second;
    if (second <= 10) {
      EXPECT_DOUBLE_EQ(heard.components.at("/player").rates.at("/scan"), 4) << second;
    }
    if (second > 20) {
      EXPECT_DOUBLE_EQ(heard.components.at("/player").rates.at("/scan"), 2) << second;
    }
    EXPECT_DOUBLE_EQ(heard.components.at("/slam").rates.at("/pose"), 0);
  }
}

}  // namespace
}  // namespace self_awareness::ros1
