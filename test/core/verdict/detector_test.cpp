#include "self_awareness/core/verdict/detector.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "self_awareness/core/stream/clock.h"
#include "self_awareness/core/verdict/persistence.h"
#include "told_judge.h"

namespace self_awareness::core {
namespace {

class DetectorTest : public ToldTest {
 protected:
  /// Passes windows for as long as an alarm stands, at most so many; returns their number.
  int windowsOfAlarm(int most = 1000) {
    int number = 0;
    while (number < most && window().alarm) {
      ++number;
    }
    return number;
  }
};

TEST_F(DetectorTest, AStartAndAStepOfTheClockSettle) {
  start();
  for (const std::int64_t step : {kLongestSilence + kSecond, -500 * kSecond}) {
    EXPECT_FALSE(window().settling);
    now_ += step;
    EXPECT_FALSE(detector_->add({now_, 0})) << "another recording";
    told_->abnormal = true;
    for (std::int64_t passed = kWindow; passed <= kSecond; passed += kWindow) {
      EXPECT_TRUE(window().settling) << passed;
      EXPECT_FALSE(verdict_.alarm || verdict_.suspicion);
    }
    told_->abnormal = false;
  }
}

TEST_F(DetectorTest, AResumedAlarmStandsUntilItsSuspectIsHeardForLongEnough) {
  start();
  changes_ = 0;
  Suspect silent = suspect("/0", 1);
  silent.since = 7;
  detector_->resume({silent});
  EXPECT_EQ(windowsOfAlarm(100), 100);
  EXPECT_EQ(alarmWindow({silent}).suspects.at(0).since, 7) << "it was named before";
  EXPECT_EQ(changes_, 0);
  detector_->add({now_, 1});
  // It settles for 1 s, and the hold time is 2 s.
  EXPECT_NEAR(windowsOfAlarm(), 29, 1);
  EXPECT_EQ(changes_, 1);
}

TEST_F(DetectorTest, AResumedAlarmWhoseSuspectsCameAllTheTimeStandsWhileAllSettle) {
  Suspect fast = suspect("/0", 0);
  fast.reason.kind = Kind::kFast;
  for (const bool cleared : {false, true}) {
    start();
    detector_->restart();
    detector_->resume({fast});
    if (cleared) {
      detector_->clearAlarm();
    }
    detector_->add({now_, 0});
    EXPECT_NEAR(windowsOfAlarm(), cleared ? 0 : 29, cleared ? 0 : 1);
  }
}

TEST_F(DetectorTest, WhoStopTogetherAreANewModeOnceTheyStayAway) {
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

TEST_F(DetectorTest, AMachineThatIsBusyNowAndThenIsOneSuspicion) {
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

TEST_F(DetectorTest, AfterAPauseTheJudgeSaysWhatHasSettled) {
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

TEST_F(DetectorTest, AnAlarmThatStandsOutlastsAPause) {
  start();
  EXPECT_TRUE(alarmWindow({suspect("/a", 0)}).alarm);
  detector_->hear({now_ - kSecond, now_, kSecond});
  windows(30);
  EXPECT_TRUE(verdict_.alarm);
  EXPECT_EQ(changes_, 1);
  windows(100);
  EXPECT_FALSE(verdict_.alarm);
}

TEST_F(DetectorTest, APauseBeforeTimeWentBackHoldsNoAlarmOfAfterIt) {
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

TEST_F(DetectorTest, OneAbnormalWindowIsASuspicionThatEndsAfterTheHoldTime) {
  start();
  told_->score = -1.5;
  EXPECT_TRUE(abnormalWindow().suspicion);
  EXPECT_EQ(verdict_.score, -1.5);
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

TEST_F(DetectorTest, AnAlarmTakesThePlaceOfTheSuspicionWhichMayOutlastIt) {
  for (const bool outlasts : {false, true}) {
    start();
    changes_ = 0;
    told_->abnormal = true;
    windows(2);
    EXPECT_TRUE(verdict_.suspicion);
    EXPECT_TRUE(window().alarm);
    EXPECT_TRUE(verdict_.changed);
    EXPECT_FALSE(verdict_.suspicion);
    told_->abnormal = false;
    told_->suspicious = outlasts;
    windows(19);
    EXPECT_TRUE(verdict_.alarm);
    EXPECT_FALSE(window().alarm);
    EXPECT_TRUE(verdict_.changed);
    EXPECT_EQ(verdict_.suspicion, outlasts);
    EXPECT_FALSE(window().changed);
    EXPECT_EQ(changes_, 3);
  }
}

TEST_F(DetectorTest, AStandingAlarmTellsOfNewSuspects) {
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

TEST_F(DetectorTest, NewSuspectsMayComeAfterTheBestFiveAndWithoutAComponent) {
  start();
  std::vector<Suspect> suspects;
  for (EventId id = 0; id < 7; ++id) {
    suspects.push_back(suspect(id < 6 ? "/" + std::to_string(id) : "", id));
  }
  EXPECT_EQ(alarmWindow(suspects).suspects.size(), kMostSuspects);
  for (const EventId late : {EventId{7}, EventId{8}}) {
    suspects.push_back(suspect(late == 7 ? "/late" : "", late));
    alarmWindow(suspects);
    EXPECT_EQ(verdict_.suspects.size(), kMostSuspects);
    EXPECT_EQ(verdict_.new_suspects.at(0).id, late);
    EXPECT_FALSE(alarmWindow(suspects).changed);
  }
}

TEST_F(DetectorTest, UnknownEventsAreToldOnceByDefaultAndThenCounted) {
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

TEST_F(DetectorTest, WhoIsNewIsToldWhileASuspicionStandsAndNoOtherSuspect) {
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

TEST_F(DetectorTest, UnknownEventsMayBeIgnoredOrAnAlarmAtOnceForAsLongAsTheyCome) {
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

TEST_F(DetectorTest, SettlingHoldsASuspicionOff) {
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

TEST_F(DetectorTest, AStandingSuspicionStandsWhileItSettles) {
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

TEST_F(DetectorTest, AStandingAlarmStandsAsLongAsItsCauseWhileItSettles) {
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

TEST_F(DetectorTest, EveryEventTypeSettlesAfterItsFirstEvent) {
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

TEST_F(DetectorTest, WithoutCalibrationNothingIsSuspicious) {
  start(UnknownEvents::kError);
  told_->threshold.reset();
  told_->suspicious = true;
  EXPECT_FALSE(window(kUnknownId).suspicion);
  EXPECT_FALSE(verdict_.alarm);
  EXPECT_FALSE(verdict_.abnormal);
}

TEST_F(DetectorTest, ClearingTheAlarmForgetsTheSuspicion) {
  start();
  abnormalWindow();
  detector_->clearAlarm();
  EXPECT_FALSE(window().suspicion);
}

TEST(Persistence, RaisesAtKOfNAndClearsAfterTheHoldTime) {
  Persistence persistence({3, 5, 200});
  std::int64_t end = 0;
  const auto add = [&](bool abnormal) { return persistence.add(abnormal, end += 100); };
  for (const bool abnormal : {true, false, true, false, false}) {
    EXPECT_FALSE(add(abnormal));
  }
  EXPECT_FALSE(add(true));  // 2 of the last 5
  EXPECT_FALSE(add(false));
  EXPECT_FALSE(add(true));
  EXPECT_TRUE(add(true));  // 3 of 5
  EXPECT_TRUE(add(false));
  EXPECT_FALSE(add(false));
}

TEST(Persistence, RefusesImpossibleValues) {
  EXPECT_THROW(Persistence({0, 5, 0}), std::invalid_argument);
  EXPECT_THROW(Persistence({6, 5, 0}), std::invalid_argument);
  EXPECT_THROW(Persistence({1, 5, -1}), std::invalid_argument);
}

}  // namespace
}  // namespace self_awareness::core
