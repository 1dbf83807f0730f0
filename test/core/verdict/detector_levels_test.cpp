#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "accepted.h"
#include "told_judge.h"

namespace self_awareness::core {
namespace {

class DetectorLevelsTest : public ToldTest {};

TEST_F(DetectorLevelsTest, WhoStopTogetherAreANewModeOnceTheyStayAway) {
  start();
  told_->silent = Silent{};
  told_->silent->others_go_on = true;
  told_->silent->components = {"/arm", "/base", "/camera", "/lidar"};
  windows(2);
  told_->silent.reset();
  windows(10);
  EXPECT_EQ(changes_, 0) << "a busy machine held them up";
  told_->silent = Silent{};
  told_->silent->others_go_on = true;
  windows(2);
  EXPECT_FALSE(verdict_.suspicion || verdict_.silent);
  EXPECT_TRUE(window().suspicion && verdict_.silent);
  told_->silent.reset();
  windows(21);
  EXPECT_EQ(changes_, 2);
  told_->silent = Silent{};  // all of them
  EXPECT_TRUE(abnormalWindow().suspicion && verdict_.silent) << "at once";
}

TEST_F(DetectorLevelsTest, AMachineThatIsBusyNowAndThenIsOneSuspicion) {
  start();
  for (int time = 0; time < 3; ++time) {
    told_->busy = Busy{};
    told_->suspicious = true;
    windows(1);
    told_->busy.reset();
    told_->suspicious = false;
    windows(99);
    EXPECT_TRUE(verdict_.suspicion);
  }
  EXPECT_EQ(changes_, 1);
  EXPECT_FALSE(window().suspicion);
  told_->suspicious = true;
  windows(1);
  told_->suspicious = false;
  windows(20);
  EXPECT_FALSE(verdict_.suspicion) << "others end sooner";
}

TEST_F(DetectorLevelsTest, AfterAPauseTheJudgeSaysWhatHasSettled) {
  start();
  const std::int64_t begin = now_;
  detector_->hear({begin, begin + kSecond, Waiting::kStoodStill});
  abnormalWindow();
  EXPECT_FALSE(verdict_.settling) << "it went on";
  detector_->hear({begin + kSecond, begin + 2 * kSecond, Waiting::kStoodStill + 1});
  while (now_ < begin + 5 * kSecond) {
    abnormalWindow();
    EXPECT_TRUE(verdict_.settling);
  }
  EXPECT_FALSE(window().settling);
}

TEST_F(DetectorLevelsTest, AnAlarmThatStandsOutlastsAPause) {
  start();
  EXPECT_TRUE(alarmWindow({suspect("/a", 0)}).alarm);
  detector_->hear({now_ - kSecond, now_, kSecond});
  windows(30);
  EXPECT_TRUE(verdict_.alarm);
  EXPECT_EQ(changes_, 1);
  windows(100);
  EXPECT_FALSE(verdict_.alarm);
}

TEST_F(DetectorLevelsTest, APauseBeforeTimeWentBackHoldsNoAlarmOfAfterIt) {
  start();
  detector_->hear({99 * kSecond, 100 * kSecond, kSecond});
  detector_->restart();
  now_ = 0;
  detector_->add({0, 0});
  windows(10);
  EXPECT_TRUE(alarmWindow({suspect("/a", 0)}).alarm);
  windows(30);
  EXPECT_FALSE(verdict_.alarm);
}

TEST_F(DetectorLevelsTest, OneAbnormalWindowIsASuspicionThatEndsAfterTheHoldTime) {
  start();
  EXPECT_TRUE(abnormalWindow().suspicion);
  EXPECT_TRUE(verdict_.changed);
  EXPECT_FALSE(verdict_.alarm);
  EXPECT_EQ(verdict_.suspects.size(), 1U);
  windows(19);
  EXPECT_TRUE(verdict_.suspicion);
  EXPECT_FALSE(verdict_.changed);
  EXPECT_TRUE(verdict_.suspects.empty());
  EXPECT_FALSE(window().suspicion);
  EXPECT_TRUE(verdict_.changed);
  EXPECT_EQ(changes_, 2);
}

TEST_F(DetectorLevelsTest, AnAlarmTakesThePlaceOfTheSuspicion) {
  start();
  told_->abnormal = true;
  windows(2);
  EXPECT_TRUE(verdict_.suspicion);
  EXPECT_TRUE(window().alarm);
  EXPECT_TRUE(verdict_.changed);
  EXPECT_FALSE(verdict_.suspicion);
  told_->abnormal = false;
  windows(19);
  EXPECT_TRUE(verdict_.alarm);
  EXPECT_FALSE(window().alarm);
  EXPECT_TRUE(verdict_.changed);
  EXPECT_FALSE(verdict_.suspicion);
  EXPECT_EQ(changes_, 3);
}

TEST_F(DetectorLevelsTest, ASuspicionMayOutlastTheAlarm) {
  start();
  told_->abnormal = true;
  windows(3);
  told_->abnormal = false;
  told_->suspicious = true;
  windows(19);
  EXPECT_TRUE(verdict_.alarm);
  EXPECT_FALSE(window().alarm);
  EXPECT_TRUE(verdict_.suspicion);
  EXPECT_TRUE(verdict_.changed);
  EXPECT_FALSE(window().changed);
}

TEST_F(DetectorLevelsTest, AStandingAlarmTellsOfNewSuspects) {
  start();
  alarmWindow({suspect("/a", 0), suspect("/b", 1, false)});
  const std::int64_t raised = now_;
  EXPECT_TRUE(verdict_.changed);
  EXPECT_TRUE(verdict_.new_suspects.empty()) << "it names all of them";
  EXPECT_FALSE(alarmWindow({suspect("/a", 0), suspect("/b", 1)}).changed);
  EXPECT_FALSE(alarmWindow({suspect("/a", 2)}).changed) << "another topic of a component";
  EXPECT_FALSE(alarmWindow({suspect("/c", 3, false)}).changed) << "weak evidence is no news";
  alarmWindow({suspect("/a", 0), suspect("/c", 3), suspect("/c", 4)});
  EXPECT_TRUE(verdict_.changed);
  EXPECT_TRUE(verdict_.alarm);
  ASSERT_EQ(verdict_.new_suspects.size(), 1U);
  EXPECT_EQ(verdict_.new_suspects[0].id, 3U);
  EXPECT_EQ(verdict_.new_suspects[0].since, now_);
  EXPECT_EQ(verdict_.suspects[0].since, raised);
  EXPECT_EQ(verdict_.suspects[2].since, now_);
  EXPECT_FALSE(alarmWindow({suspect("/c", 3)}).changed);
  EXPECT_LT(verdict_.suspects[0].since, now_);
  EXPECT_EQ(changes_, 2);
}

TEST_F(DetectorLevelsTest, EventTypesWhoseComponentIsNotKnownAreNewOneByOne) {
  start();
  alarmWindow({suspect("", 8)});
  EXPECT_FALSE(alarmWindow({suspect("", 8)}).changed);
  EXPECT_EQ(alarmWindow({suspect("", 8), suspect("", 9)}).new_suspects.at(0).id, 9U);
}

TEST_F(DetectorLevelsTest, NewSuspectsMayComeAfterTheBestFive) {
  start();
  std::vector<Suspect> suspects;
  for (EventId id = 0; id < 7; ++id) {
    suspects.push_back(suspect("/" + std::to_string(id), id));
  }
  EXPECT_EQ(alarmWindow(suspects).suspects.size(), kMostSuspects);
  suspects.push_back(suspect("/late", 7));
  alarmWindow(suspects);
  EXPECT_EQ(verdict_.suspects.size(), kMostSuspects);
  ASSERT_EQ(verdict_.new_suspects.size(), 1U);
  EXPECT_EQ(verdict_.new_suspects[0].id, 7U);
}

TEST_F(DetectorLevelsTest, UnknownEventsAreToldOnceByDefaultAndThenCounted) {
  start();
  EXPECT_TRUE(window(kUnknownId).suspicion);
  EXPECT_FALSE(verdict_.abnormal);
  EXPECT_FALSE(verdict_.alarm);
  EXPECT_EQ(verdict_.evidence, "unknown events");
  EXPECT_EQ(verdict_.suspects.size(), 1U);
  for (int i = 0; i < 20; ++i) {
    window(kUnknownId);
    EXPECT_EQ(verdict_.evidence, "");
  }
  EXPECT_FALSE(verdict_.suspicion) << "it goes on, and is no news";
  EXPECT_EQ(detector_->unknown(), (std::map<EventId, std::uint64_t>{{kUnknownId, 21}}));
  detector_->restart();
  EXPECT_TRUE(detector_->unknown().empty());
}

TEST_F(DetectorLevelsTest, WhoIsNewIsToldWhileASuspicionStandsAndNoOtherSuspect) {
  start();
  told_->suspicious = true;
  told_->suspects = {suspect("/a", 0)};
  window();
  told_->suspects = {suspect("/b", 1)};
  EXPECT_FALSE(window().changed);
  EXPECT_TRUE(verdict_.suspicion);
  told_->suspects = {suspect("/a", 0), suspect("", kUnknownId)};
  EXPECT_TRUE(window(kUnknownId).changed);
  ASSERT_EQ(verdict_.new_suspects.size(), 1U);
  EXPECT_EQ(verdict_.new_suspects[0].id, kUnknownId);
  EXPECT_FALSE(window(kUnknownId).changed);
}

TEST_F(DetectorLevelsTest, UnknownEventsMayBeIgnoredOrAnAlarmAtOnceForAsLongAsTheyCome) {
  start(UnknownEvents::kIgnore);
  EXPECT_FALSE(window(kUnknownId).suspicion);
  EXPECT_EQ(verdict_.evidence, "");
  EXPECT_EQ(changes_, 0);
  start(UnknownEvents::kError);
  EXPECT_FALSE(window(0).alarm);
  for (int i = 0; i < 50; ++i) {
    EXPECT_TRUE(window(kUnknownId).alarm);
  }
  EXPECT_TRUE(verdict_.abnormal);
  EXPECT_EQ(verdict_.evidence, "unknown events");
  told_->evidence = "rate";
  EXPECT_EQ(window(kUnknownId).evidence, "rate, unknown events");
}

TEST_F(DetectorLevelsTest, SettlingHoldsASuspicionOff) {
  for (const UnknownEvents unknown : {UnknownEvents::kWarn, UnknownEvents::kError}) {
    start(unknown);
    changes_ = 0;
    told_->settling = true;
    for (int i = 0; i < 10; ++i) {
      told_->abnormal = i % 3 == 0;
      window(kUnknownId);
      EXPECT_TRUE(verdict_.settling);
      EXPECT_FALSE(verdict_.suspicion) << i;
      EXPECT_FALSE(verdict_.alarm) << i;
      EXPECT_TRUE(verdict_.suspects.empty());
    }
    told_->abnormal = told_->settling = false;
    EXPECT_EQ(changes_, 0);
    window(kUnknownId);
    EXPECT_EQ(verdict_.suspicion, unknown == UnknownEvents::kWarn);
    EXPECT_EQ(verdict_.alarm, unknown == UnknownEvents::kError);
  }
}

TEST_F(DetectorLevelsTest, AStandingSuspicionStandsWhileItSettles) {
  start();
  abnormalWindow();
  told_->settling = true;
  windows(30);
  EXPECT_TRUE(verdict_.suspicion);
  told_->settling = false;
  windows(19);
  EXPECT_TRUE(verdict_.suspicion);
  windows(1);
  EXPECT_FALSE(verdict_.suspicion);
}

TEST_F(DetectorLevelsTest, AStandingAlarmStandsAsLongAsItsCauseWhileItSettles) {
  start();
  told_->abnormal = true;
  windows(3);
  EXPECT_TRUE(verdict_.alarm);
  told_->settling = true;
  windows(100);
  EXPECT_TRUE(verdict_.alarm);
  EXPECT_FALSE(verdict_.settling);
  EXPECT_EQ(changes_, 2);
  told_->abnormal = false;
  windows(19);
  EXPECT_TRUE(verdict_.alarm);
  windows(1);
  EXPECT_FALSE(verdict_.alarm);
  told_->abnormal = true;
  windows(100);
  EXPECT_TRUE(verdict_.settling);
  EXPECT_FALSE(verdict_.alarm);
}

TEST_F(DetectorLevelsTest, EveryEventTypeSettlesAfterItsFirstEvent) {
  start();
  EXPECT_EQ(judge_->settling(), (std::map<EventId, std::int64_t>{{0, kSecond}}));
  const std::int64_t first = now_;
  window(3);
  window(3);
  EXPECT_EQ(judge_->settling(),
            (std::map<EventId, std::int64_t>{{0, kSecond}, {3, first + kSecond}}));
  detector_->restart();
  window(3);
  EXPECT_EQ(judge_->settling(), (std::map<EventId, std::int64_t>{{3, now_ - kWindow + kSecond}}));
}

TEST_F(DetectorLevelsTest, WithoutCalibrationNothingIsSuspicious) {
  start(UnknownEvents::kError);
  told_->threshold.reset();
  told_->suspicious = true;
  EXPECT_FALSE(window(kUnknownId).suspicion);
  EXPECT_FALSE(verdict_.alarm);
  EXPECT_FALSE(verdict_.abnormal);
}

TEST_F(DetectorLevelsTest, ClearingTheAlarmForgetsTheSuspicion) {
  start();
  abnormalWindow();
  detector_->clearAlarm();
  EXPECT_FALSE(window().suspicion);
}

class DetectorAcceptTest : public ToldTest {
 protected:
  static Acceptances ofUnknown(Kind kind) { return allOf({accepted("/7", "", kind)}); }
};

TEST_F(DetectorAcceptTest, WhoIsAcceptedIsNotNewAndToldOnceMoreAfterThatIsTakenBack) {
  start();
  EXPECT_TRUE(window(kUnknownId).suspicion);
  windows(30);
  EXPECT_FALSE(verdict_.suspicion) << "it was told once";
  EXPECT_EQ(detector_->unknown().size(), 1U);
  detector_->accept(ofUnknown(Kind::kStranger));
  EXPECT_TRUE(detector_->unknown().empty());
  EXPECT_FALSE(window(kUnknownId).suspicion);
  EXPECT_TRUE(detector_->unknown().empty());
  detector_->accept({});
  EXPECT_TRUE(window(kUnknownId).suspicion) << "told again";
  windows(30);
  EXPECT_FALSE(window(kUnknownId).suspicion) << "once";
}

TEST_F(DetectorAcceptTest, WhatIsAcceptedWhileItsWindowIsOpenIsNoNews) {
  for (const UnknownEvents unknown : {UnknownEvents::kWarn, UnknownEvents::kError}) {
    start(unknown);
    detector_->add({now_, kUnknownId});
    detector_->accept(ofUnknown(Kind::kStranger));
    EXPECT_FALSE(window().suspicion);
    EXPECT_FALSE(verdict_.alarm);
  }
}

TEST_F(DetectorAcceptTest, AResumedAlarmDoesNotWaitForWhoMayBeSilent) {
  Suspect dead = suspect("/7", kUnknownId);
  dead.reason.kind = Kind::kSilent;
  for (const bool before : {false, true}) {
    start();
    if (before) {
      detector_->accept(ofUnknown(Kind::kSilent));
    }
    detector_->resume({dead});
    if (!before) {
      windows(100);
      EXPECT_TRUE(verdict_.alarm) << "it is not heard";
      detector_->accept(allOf({accepted("/0", "", Kind::kSilent)}));
      windows(100);
      EXPECT_TRUE(verdict_.alarm) << "another one is accepted";
      detector_->accept(ofUnknown(Kind::kSilent));
    }
    windows(40);
    EXPECT_FALSE(verdict_.alarm) << before;
  }
}

}  // namespace
}  // namespace self_awareness::core
