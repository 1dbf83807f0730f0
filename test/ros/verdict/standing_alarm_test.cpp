#include "ros/verdict/standing_alarm.h"

#include <gtest/gtest.h>

#include <string>

#include "one_message_case.h"

namespace self_awareness::ros1 {
namespace {

using self_awareness::SelfAwareness;

class StandingAlarmTest : public OneMessageTest<self_awareness::StandingAlarm> {
 protected:
  StandingAlarmTest()
      : OneMessageTest(writeStandingAlarm, readStandingAlarm, "the alarm in it is damaged") {
    content_.run_id = "run";
    content_.recording = "/files/alarm.bag";
    SelfAwareness& alarm = content_.alarm;
    alarm.level = SelfAwareness::ERROR;
    alarm.alarm = 1600000000000000000;
    alarm.kind = "silent";
    alarm.component = "/driver";
    alarm.evidence = "overdue";
    self_awareness::Suspect suspect;
    suspect.source = suspect.component = "/driver";
    suspect.scope = "/scan";
    suspect.type = "T";
    suspect.kind = "silent";
    suspect.since.sec = 7;
    suspect.onset.sec = 5;
    suspect.unit = "s";
    suspect.usual = 0.1;
    alarm.suspects = {suspect};
  }
  void expectRefused(const std::string& why, const std::function<void(SelfAwareness&)>& change) {
    OneMessageTest::expectRefused(why, [&](auto& standing) { change(standing.alarm); });
  }
};

TEST_F(StandingAlarmTest, IsReadAsItWasWritten) {
  EXPECT_FALSE(readStandingAlarm(path_)) << "there is no file";
  written();
  const auto read = readStandingAlarm(path_);
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, content_);
  content_.alarm.level = SelfAwareness::OK;
  written();
  EXPECT_FALSE(readStandingAlarm(path_)) << "the alarm is over";
}

TEST_F(StandingAlarmTest, ADamagedFileIsRefusedByName) {
  const std::string good = written();
  ASSERT_EQ(errorOf(good), "");
  for (std::size_t size = 0; size < good.size(); size += 37) {
    EXPECT_TRUE(begins(errorOf(good.substr(0, size)), path_ + ": ")) << size;
  }
  for (std::size_t place = 0; place < good.size(); place += 11) {
    std::string bad = good;
    bad[place] = static_cast<char>(bad[place] ^ 0xff);
    errorOf(bad);  // whatever it is, it is said or read
  }
  EXPECT_NE(errorOf("no bag"), "");
  EXPECT_NE(errorOf(std::string(2 << 20, 'x')), "");
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
  content_.alarm.component = "/\x1b[2J";
  EXPECT_NE(errorOf(written()), "") << "its texts are printable";
}

TEST_F(StandingAlarmTest, SuspectsAreThoseThatTheModelKnows) {
  core::Vocabulary vocabulary({{"/other", "/odom", "T"}, {"/driver", "/scan", "T"}});
  self_awareness::Suspect unknown = content_.alarm.suspects[0];
  unknown.scope = "/elsewhere";
  content_.alarm.suspects.push_back(unknown);
  const auto suspects = fromMessages(content_.alarm.suspects, vocabulary);
  ASSERT_EQ(suspects.size(), 1U);
  EXPECT_EQ(suspects[0].id, 1U);
  EXPECT_EQ(suspects[0].component, "/driver");
  EXPECT_EQ(suspects[0].topic, "/scan");
  EXPECT_EQ(suspects[0].onset, 5000000000);
  EXPECT_EQ(suspects[0].since, 7000000000);
  EXPECT_EQ(suspects[0].reason.usual, 0.1);
  EXPECT_EQ(suspects[0].reason.kind, core::Kind::kSilent);
}

}  // namespace
}  // namespace self_awareness::ros1
