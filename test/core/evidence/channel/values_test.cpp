#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "../judged.h"
#include "self_awareness/core/verdict/alarm.h"

namespace self_awareness::core::evidence {
namespace {

// What a navigator's goals come to; and somebody who goes on.
const std::vector<EventType> kRobot{{"/navigator", "/result", "R[status=3]"},
                                    {"/navigator", "/result", "R[status=4]"},
                                    {"/driver", "/scan", "S"}};
constexpr EventId kReached = 0;
constexpr EventId kAborted = 1;
constexpr EventId kScan = 2;
constexpr std::int64_t kEnd = 600 * kSecond;

/// A robot with a goal about every 5 s; shares of them are aborted, and from half of the time on.
Events robot(std::int64_t start, unsigned seed, double aborted, double then) {
  std::mt19937 random(seed);
  Events goals = irregular(kReached, start, start + kEnd, 5 * kSecond, seed);
  for (Event& goal : goals) {
    const double share = goal.stamp < start + kEnd / 2 ? aborted : then;
    goal.id = std::bernoulli_distribution(share)(random) ? kAborted : kReached;
  }
  return together({goals, timer(kScan, start, start + kEnd, kSecond / 5)});
}

core::Model learned(double aborted) {
  return learnedFrom(kRobot, {robot(0, 1, aborted, aborted), robot(kStart, 2, aborted, aborted),
                              robot(2 * kStart, 3, aborted, aborted)});
}

std::optional<Begun> alarmOf(const core::Model& model, double aborted, double then) {
  return alarmIn(model.makeJudge(), robot(4 * kStart, 7, aborted, then));
}

TEST(ValuesTest, GoalsThatFailMoreOftenAreFound) {
  const core::Model model = learned(0.05);
  const std::optional<Begun> alarm = alarmOf(model, 0.05, 1);
  ASSERT_TRUE(alarm);
  EXPECT_EQ(alarm->evidence, "values");
  EXPECT_GT(alarm->time, 4 * kStart + kEnd / 2);
  EXPECT_LT(alarm->time, 4 * kStart + kEnd / 2 + 60 * kSecond);
  ASSERT_FALSE(alarm->suspects.empty());
  EXPECT_EQ(alarm->suspects[0].id, kAborted);
  EXPECT_EQ(alarm->suspects[0].reason.kind, Kind::kFast);
  EXPECT_NE(alarm->suspects[0].reason.words.find(" messages, usually "), std::string::npos);
}

TEST(ValuesTest, TheUsualShareIsNoNews) {
  for (const double usual : {0.0, 0.02, 0.05, 0.2}) {
    EXPECT_FALSE(alarmOf(learned(usual), usual, usual)) << usual;
  }
}

TEST(ValuesTest, WhoSaysNothingMoreHasNoShare) {
  const core::Model model = learned(0.05);
  const std::int64_t idle = 4 * kStart + kEnd / 2 + 120 * kSecond;
  const Events goals = without(robot(4 * kStart, 7, 0.05, 1), [&](const Event& event) {
    return event.id != kScan && event.stamp > idle;
  });
  bool was_abnormal = false;
  bool is_abnormal = false;
  judge(model.makeJudge(), goals, [&](const Verdict& verdict) {
    is_abnormal = verdict.evidence.find("values") != std::string::npos;
    was_abnormal = was_abnormal || is_abnormal;
  });
  EXPECT_TRUE(was_abnormal);
  EXPECT_FALSE(is_abnormal);
}

}  // namespace
}  // namespace self_awareness::core::evidence
