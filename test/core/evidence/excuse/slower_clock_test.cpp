#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "../judged.h"
#include "self_awareness/core/verdict/alarm.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kHour = 3600 * kSecond;
constexpr std::int64_t kYears = 400000 * kHour;
constexpr std::int64_t kFault = 60 * kSecond;  // after the start
constexpr EventId kTypesOfRobot = 5;

/// A robot in simulated time, with four timers, of other phases in each start; the last type
/// answers to the one before it.
/// @param faster so many times as often from kFault on, of each that does not answer
Events robot(std::int64_t start, const std::vector<double>& faster = {1, 1, 1, 1}) {
  Events events;
  for (EventId id = 0; id < faster.size(); ++id) {
    const std::int64_t period = (60 + 30 * static_cast<std::int64_t>(id)) * kMillisecond;
    const auto then = static_cast<std::int64_t>(static_cast<double>(period) / faster[id]);
    const std::int64_t phase = id * (start / kSecond % 7) * 7 * kMillisecond;
    Events of_type = timer(id, start + phase, start + kFault, period);
    const Events after = timer(id, of_type.back().stamp + then, start + 2 * kFault, then);
    of_type.insert(of_type.end(), after.begin(), after.end());
    events = together({events, of_type});
    if (id + 1U == faster.size()) {
      events = together({events, answers(id + 1, of_type, 5 * kMillisecond)});
    }
  }
  return events;
}

class SlowerClockTest : public testing::Test {
 protected:
  SlowerClockTest() {
    for (const EventType& type : types_) {
      vocabulary_.intern(type);
    }
  }
  /// All that is told of a recording.
  std::vector<Alarm> toldOf(const Events& events) const {
    std::vector<Alarm> told;
    Alarms alarms;
    judge(learned_.makeJudge(), events, [&](const Verdict& verdict) {
      if (const auto ended = alarms.add(verdict, kWindow, vocabulary_)) {
        told.push_back(*ended);
      }
    });
    if (const auto ended = alarms.end(events.back().stamp)) {
      told.push_back(*ended);
    }
    return told;
  }
  /// The only alarm of a recording, after a suspicion.
  Alarm alarmIn(const Events& events) const {
    std::vector<Alarm> told = toldOf(events);
    told.erase(
        std::remove_if(told.begin(), told.end(),
                       [](const Alarm& each) { return each.level != Alarm::Level::kAlarm; }),
        told.end());
    EXPECT_EQ(told.size(), 1U);
    return told.empty() ? Alarm() : told.front();
  }

  const std::vector<EventType> types_ = numberedTypes(kTypesOfRobot);
  const core::Model learned_ = learnedFrom(types_, {robot(kHour), robot(2 * kHour)});
  Vocabulary vocabulary_;
};

TEST_F(SlowerClockTest, WhoKeepsAnotherTimeIsNotToBlame) {
  const std::vector<Alarm> told = toldOf(robot(kSecond, {1, 2.5, 2.5, 1}));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].level, Alarm::Level::kSuspicion);
  EXPECT_EQ(told[0].kind, Kind::kSlowerClock);
  EXPECT_EQ(told[0].culprit, "");
  EXPECT_EQ(told[0].evidence, "clock");
  EXPECT_EQ(told[0].reason,
            "the simulation may run slower: 2 nodes send 2.5 times as often by its clock");
}

TEST_F(SlowerClockTest, WhoDiesMeanwhileIsToBlame) {
  const Events slower = robot(kSecond, {1, 2.5, 2.5, 1});
  const Alarm alarm = alarmIn(without(slower, [](const Event& event) {
    return event.id == 1 && event.stamp > kFault + 20 * kSecond;
  }));
  EXPECT_EQ(alarm.culprit, "/c1");
  EXPECT_EQ(alarm.kind, Kind::kSilent);
}

TEST_F(SlowerClockTest, WhenItIsOverNobodyIsLeft) {
  const Events slower = robot(kSecond, {1, 2.5, 2.5, 1});
  const std::vector<Alarm> told = toldOf(together({slower, later(robot(kSecond), 2 * kFault)}));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told[0].reason.find(": 2 nodes send 2.5 times"), std::string::npos) << told[0].reason;
  EXPECT_TRUE(told[0].over);
  EXPECT_LT(told[0].end, 2 * kFault + 30 * kSecond);
}

TEST_F(SlowerClockTest, ItIsTheirsInRealTimeByOtherFactorsOrWhereOthersAnswer) {
  for (const auto& [events, culprit] : {std::pair{robot(kYears, {1, 2.5, 2.5, 1}), "/c1"},
                                        {robot(kSecond, {1, 1.6, 4, 1}), "/c1"},
                                        {robot(kSecond, {1, 1, 1, 2.5}), "/c3"}}) {
    const Alarm alarm = alarmIn(events);
    EXPECT_EQ(alarm.kind, Kind::kFast) << culprit;
    EXPECT_EQ(alarm.culprit, culprit);
  }
}

}  // namespace
}  // namespace self_awareness::core::evidence
