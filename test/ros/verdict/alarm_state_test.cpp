#include "ros/verdict/alarm_state.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../times.h"

namespace self_awareness::ros1 {
namespace {

using self_awareness::SelfAwareness;

class AlarmStateTest : public testing::Test {
 protected:
  AlarmStateTest() {
    vocabulary_.intern({"/player", "/scan", "std_msgs/String"});
    vocabulary_.intern({"/arm", "/joints", "std_msgs/String"});
  }

  enum class Level { kOk, kSuspicion, kAlarm };
  core::Verdict verdict(Level level, bool changed, const std::string& evidence = "") {
    core::Verdict verdict;
    verdict.window = &window_;
    verdict.score = -2;
    verdict.threshold = -1;
    verdict.alarm = level == Level::kAlarm;
    verdict.suspicion = level == Level::kSuspicion;
    verdict.changed = changed;
    verdict.evidence = evidence;
    if (!evidence.empty()) {
      verdict.abnormal = true;
      core::Suspect suspect;
      suspect.id = 0;
      suspect.reason.words = "silent for 1 s";
      verdict.suspects = {suspect};
    }
    return verdict;
  }
  void add(const core::Verdict& verdict) {
    alarm_.add(verdict, vocabulary_, kWindow, {"", "/data/alarm_1.bag"});
    window_.start += kWindow;
  }

  core::Vocabulary vocabulary_;
  core::Window window_{kStart, {}};
  std::vector<std::string> told_;  // whom alarms named
  int diagnostics_ = 0;            // how often they were asked for
  AlarmState alarm_{{[](const SelfAwareness& /*status*/) {},
                     [this](const SelfAwareness& alarm) { told_.push_back(alarm.component); },
                     [this] { ++diagnostics_; }}};
  const std::string file_ = "; events in /data/alarm_1.bag";
};

TEST_F(AlarmStateTest, NamesTheComputersThatFellSilentBeforeTheSuspects) {
  core::Verdict silent = verdict(Level::kAlarm, true, "overdue");
  silent.silent = core::Silent{{"base"}, {"/imu", "/player"}, kStart};
  silent.suspects.clear();
  add(silent);
  EXPECT_EQ(alarm_.message().message,
            "everything on host base fell silent at 12:26:40 UTC: 2 nodes (overdue)" + file_);
  EXPECT_EQ(alarm_.message().kind, SelfAwareness::ALL_SILENT);
  EXPECT_EQ(alarm_.message().component, "");
  EXPECT_EQ(alarm_.message().reason, "everything on host base fell silent: 2 nodes");
}

TEST_F(AlarmStateTest, TellsTheWindow) {
  const SelfAwareness& said = alarm_.message();
  core::Verdict settling = verdict(Level::kOk, false);
  settling.abnormal = settling.settling = true;
  add(settling);
  EXPECT_FALSE(said.abnormal) << "not held against anyone while it settles";
  EXPECT_TRUE(said.settling);
  EXPECT_EQ(said.message, "settling");
  window_ = {kStart, {{{kStart, 0}, false, {}}, {{kStart + 1, 7}, true, {}}}};
  add(verdict(Level::kAlarm, true, "overdue"));
  EXPECT_EQ(said.window_start.toNSec(), static_cast<std::uint64_t>(kStart));
  EXPECT_EQ(said.window.toNSec(), kWindow);
  EXPECT_EQ(said.header.stamp.toNSec(), static_cast<std::uint64_t>(kStart + kWindow));
  EXPECT_EQ(said.level, SelfAwareness::ERROR);
  EXPECT_EQ(said.score, -2);
  EXPECT_EQ(said.threshold, -1);
  EXPECT_TRUE(said.abnormal);
  EXPECT_EQ(said.events, 2U);
  EXPECT_EQ(said.unknown_events, 1U);
}

TEST_F(AlarmStateTest, AnAlarmKeepsWhatItSaysUntilItIsOver) {
  const SelfAwareness& said = alarm_.message();
  EXPECT_FALSE(alarm_.spoken() || alarm_.stands()) << "before the first window";
  core::Verdict empty = verdict(Level::kOk, false);
  empty.score.reset();
  empty.threshold.reset();
  add(empty);
  EXPECT_TRUE(alarm_.spoken());
  EXPECT_TRUE(std::isnan(said.score) && std::isnan(said.threshold));
  add(verdict(Level::kOk, false));
  EXPECT_EQ(said.message, "normal communication");
  EXPECT_EQ(said.alarm, 0U);
  EXPECT_EQ(said.kind + said.component + said.reason, "");
  add(verdict(Level::kAlarm, true, "overdue"));
  const std::uint64_t id = said.alarm;
  EXPECT_EQ(id, alarm_.standing()->id);
  EXPECT_EQ(said.kind, SelfAwareness::SILENT);
  EXPECT_EQ(said.reason, "silent for 1 s");
  add(verdict(Level::kAlarm, false));
  EXPECT_TRUE(alarm_.stands());
  EXPECT_FALSE(said.abnormal);
  EXPECT_EQ(said.alarm, id);
  EXPECT_EQ(said.component, "/player");
  EXPECT_EQ(said.evidence, "overdue");
  ASSERT_EQ(said.suspects.size(), 1U);
  EXPECT_EQ(said.suspects[0].source, "/player");
  EXPECT_EQ(said.message, "/player (/scan) stopped sending at 12:26:40 UTC (overdue)" + file_);
  add(verdict(Level::kOk, true));
  EXPECT_FALSE(alarm_.stands());
  EXPECT_EQ(said.message, "normal communication");
  EXPECT_EQ(said.alarm, id) << "that is over";
  EXPECT_EQ(said.evidence, "");
  EXPECT_TRUE(said.suspects.empty());
  add(verdict(Level::kOk, false));
  EXPECT_EQ(said.alarm, 0U);
  EXPECT_EQ(said.kind + said.component + said.reason, "");
}

TEST_F(AlarmStateTest, CountsHowLongTheLevelHasStood) {
  add(verdict(Level::kOk, false));
  add(verdict(Level::kSuspicion, true, "rate"));
  const std::int64_t changed = window_.start;  // the end of that window
  add(verdict(Level::kSuspicion, false, "rate"));
  EXPECT_EQ(alarm_.message().message, "/player (/scan) stopped sending at 12:26:40 UTC (rate)")
      << "no file is written for it";
  EXPECT_DOUBLE_EQ(alarm_.standsFor(changed + 3 * kWindow), 0.3);
  add(verdict(Level::kAlarm, true, "rate"));
  EXPECT_DOUBLE_EQ(alarm_.standsFor(window_.start), 0);
}

TEST_F(AlarmStateTest, NewSuspectsAreNamedInWordsWithTheWindowThatNamesThem) {
  add(verdict(Level::kAlarm, true, "overdue"));
  const std::int64_t raised = window_.start;
  add(verdict(Level::kAlarm, false, "overdue"));
  const std::string before = alarm_.message().message;
  core::Verdict second = verdict(Level::kAlarm, true, "overdue, rate");
  core::Suspect arm;
  arm.id = 1;
  arm.reason = core::strangerIn(2);
  arm.since = window_.start + kWindow;
  second.new_suspects = {arm};
  second.suspects.push_back(arm);
  add(second);
  EXPECT_EQ(alarm_.message().message,
            "/player (/scan) stopped sending at 12:26:40 UTC (overdue, rate); now also /arm on "
            "/joints: never seen in training, 2 in this window" +
                file_);
  EXPECT_EQ(alarm_.message().suspects[1].since.toNSec(),
            static_cast<std::uint64_t>(window_.start));
  EXPECT_DOUBLE_EQ(alarm_.standsFor(raised + 3 * kWindow), 0.3) << "the alarm is the same";
  add(verdict(Level::kAlarm, false, "overdue"));
  EXPECT_EQ(alarm_.message().message, before);
}

TEST_F(AlarmStateTest, StandsDownWithAReason) {
  add(verdict(Level::kAlarm, true, "overdue"));
  alarm_.standDown("cleared by hand", kStart + 42);
  EXPECT_FALSE(alarm_.stands());
  const SelfAwareness& said = alarm_.message();
  EXPECT_EQ(said.level, SelfAwareness::OK);
  EXPECT_EQ(said.message, "cleared by hand");
  EXPECT_EQ(said.header.stamp.toNSec(), static_cast<std::uint64_t>(kStart + 42));
  EXPECT_FALSE(said.abnormal);
  EXPECT_EQ(said.evidence, "");
  EXPECT_TRUE(said.suspects.empty());
  EXPECT_EQ(said.score, -2) << "of the last window";
  alarm_.standDown("again", kStart + 43);
}

TEST_F(AlarmStateTest, AnAlarmStandsThroughAChangeOfModelUntilItIsTakenBack) {
  add(verdict(Level::kAlarm, true, "overdue"));
  alarm_.forgetWindow();
  EXPECT_FALSE(alarm_.spoken());
  EXPECT_TRUE(alarm_.stands());
  EXPECT_TRUE(alarm_.message().suspects.empty()) << "ids of another model";
  alarm_.standDown("settling: model loaded", kStart);
  EXPECT_FALSE(alarm_.stands());
  EXPECT_TRUE(alarm_.spoken());
}

TEST_F(AlarmStateTest, SaysThatAnotherOneIsToBlame) {
  core::Verdict both = verdict(Level::kAlarm, true, "overdue");
  core::Suspect& player = both.suspects[0];
  player.abnormal = true;
  player.onset = kStart - kWindow;
  player.missed = kStart;
  add(both);
  both.changed = false;
  add(both);
  EXPECT_EQ(told_, (std::vector<std::string>{"/player"}));
  core::Suspect arm;
  arm.id = 1;
  arm.abnormal = true;
  arm.onset = kStart - 9 * kWindow;
  arm.missed = kStart - 2 * kWindow;
  both.suspects.insert(both.suspects.begin(), arm);
  both.new_suspects = {arm};
  add(both);
  EXPECT_EQ(told_, (std::vector<std::string>{"/player", "/arm"}));
  EXPECT_EQ(diagnostics_, 2);
}

}  // namespace
}  // namespace self_awareness::ros1
