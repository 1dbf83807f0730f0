#include "ros/verdict/standing_alarm.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "kept_file_case.h"

namespace self_awareness::ros1 {
namespace {

using self_awareness::SelfAwareness;

class StandingAlarmTest : public KeptFileTest {
 protected:
  StandingAlarmTest() {
    standing_.run_id = "run";
    standing_.recording = "/files/alarm.bag";
    SelfAwareness& alarm = standing_.alarm;
    alarm.level = SelfAwareness::ERROR;
    alarm.alarm = 1600000000000000000;
    alarm.kind = "died";
    alarm.component = "/driver";
    alarm.evidence = "overdue";
    self_awareness::Suspect suspect;
    suspect.source = suspect.component = "/driver";
    suspect.scope = "/scan";
    suspect.type = "T";
    suspect.kind = "died";
    suspect.since.sec = 7;
    alarm.suspects = {suspect};
  }
  void write() override { writeStandingAlarm(standing_, path_); }
  void read() override { readStandingAlarm(path_); }
  void expectRefused(const std::string& why, const std::function<void(SelfAwareness&)>& change) {
    const self_awareness::StandingAlarm before = standing_;
    change(standing_.alarm);
    EXPECT_EQ(errorOf(written()), path_ + ": the alarm in it is damaged (" + why + ")");
    standing_ = before;
  }

  self_awareness::StandingAlarm standing_;
};

TEST_F(StandingAlarmTest, IsReadAsItWasWritten) {
  EXPECT_FALSE(readStandingAlarm(path_)) << "there is no file";
  written();
  const auto read = readStandingAlarm(path_);
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, standing_);
  standing_.alarm.level = SelfAwareness::OK;
  written();
  EXPECT_FALSE(readStandingAlarm(path_)) << "the alarm is over";
}

TEST_F(StandingAlarmTest, ADamagedFileIsRefusedByName) {
  expectNoBeliefInDamage();
}

TEST_F(StandingAlarmTest, WhatCannotBeIsRefused) {
  expectRefused("its level is none", [](SelfAwareness& alarm) { alarm.level = 3; });
  expectRefused("its id is none", [](SelfAwareness& alarm) { alarm.alarm = 0; });
  expectRefused("its id is none", [](SelfAwareness& alarm) { alarm.alarm = ~0ULL; });
  expectRefused("its kind is none", [](SelfAwareness& alarm) { alarm.kind = "odd"; });
  expectRefused("the kind of a suspect is none",
                [](SelfAwareness& alarm) { alarm.suspects[0].kind = ""; });
  expectRefused("it has too many suspects", [](SelfAwareness& alarm) {
    alarm.suspects.resize(core::kMostSuspects + 1, alarm.suspects[0]);
  });
  standing_.alarm.component = "/\x1b[2J";
  EXPECT_NE(errorOf(written()), "") << "its texts are printable";
}

TEST_F(StandingAlarmTest, SuspectsAreThoseThatTheModelKnows) {
  core::Vocabulary vocabulary({{"/other", "/odom", "T"}, {"/driver", "/scan", "T"}});
  self_awareness::Suspect unknown = standing_.alarm.suspects[0];
  unknown.scope = "/elsewhere";
  standing_.alarm.suspects.push_back(unknown);
  const auto suspects = fromMessages(standing_.alarm.suspects, vocabulary);
  ASSERT_EQ(suspects.size(), 1U);
  EXPECT_EQ(suspects[0].id, 1U);
  EXPECT_EQ(suspects[0].component, "/driver");
  EXPECT_EQ(suspects[0].since, 7000000000);
  EXPECT_EQ(suspects[0].reason.kind, core::Kind::kDied);
}

}  // namespace
}  // namespace self_awareness::ros1
