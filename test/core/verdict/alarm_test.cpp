#include "self_awareness/core/verdict/alarm.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/verdict/sentence.h"

namespace self_awareness::core {
namespace {

constexpr std::int64_t kWindow = 100000000;  // [ns]
constexpr std::int64_t kStart = 50 * kWindow;

enum Level { kOk, kSuspicion, kAlarm };

class AlarmsTest : public testing::Test {
 protected:
  AlarmsTest() : vocabulary_({{"/a", "/x", "T"}, {"/b", "/y", "T"}, {"", "/z", "T"}}) {}

  static Suspect suspect(EventId id, Kind kind) {
    Suspect suspect;
    suspect.id = id;
    suspect.reason.kind = kind;
    return suspect;
  }
  /// One that alone is abnormal.
  static Suspect missing(EventId id) {
    Suspect missing = suspect(id, Kind::kSilent);
    missing.abnormal = true;
    return missing;
  }
  /// One that came last at a moment [ns], and usually does within a window.
  static Suspect silentSince(EventId id, std::int64_t onset) {
    Suspect silent = missing(id);
    silent.onset = onset;
    silent.missed = onset + kWindow;
    return silent;
  }
  /// The verdict on the next window; an abnormal one blames suspects.
  Verdict verdict(Level level, const std::vector<Suspect>& suspects = {}) {
    Verdict verdict;
    verdict.window = &window_;
    verdict.alarm = level == kAlarm;
    verdict.suspicion = level == kSuspicion;
    verdict.score = suspects.empty() ? 0 : -2;
    verdict.evidence = suspects.empty() ? "" : "overdue";
    verdict.suspects = suspects;
    return verdict;
  }
  std::optional<Alarm> add(const Verdict& verdict) {
    std::optional<Alarm> ended = alarms_.add(verdict, kWindow, vocabulary_);
    window_.start += kWindow;
    return ended;
  }

  /// The next window of an alarm, in which the machine is busy, or some are silent together, who
  /// are no suspects then.
  void addBusy(const Busy& busy, const std::vector<Suspect>& suspects = {}) {
    Verdict next = verdict(kAlarm, suspects);
    next.evidence = "busy";
    next.busy = busy;
    add(next);
  }
  void addSilent(const Silent& silent, const std::vector<Suspect>& suspects = {}) {
    Verdict next = verdict(kAlarm, suspects);
    next.silent = silent;
    add(next);
  }
  void expectBlamed(const std::string& culprit, Kind kind) const {
    ASSERT_TRUE(alarms_.standing());
    EXPECT_EQ(alarms_.standing()->culprit, culprit);
    EXPECT_EQ(toString(alarms_.standing()->kind), toString(kind));
  }

  Vocabulary vocabulary_;
  Window window_{kStart, {}};
  Alarms alarms_;
};

TEST_F(AlarmsTest, AnAlarmLastsFromTheWindowThatRaisedItToTheOneThatEndedIt) {
  EXPECT_FALSE(add(verdict(kOk)));
  EXPECT_FALSE(alarms_.standing());
  EXPECT_FALSE(add(verdict(kAlarm, {suspect(1, Kind::kSilent), suspect(0, Kind::kSlow)})));
  ASSERT_TRUE(alarms_.standing());
  EXPECT_FALSE(alarms_.standing()->over);
  add(verdict(kAlarm));
  const std::optional<Alarm> ended = add(verdict(kOk));
  ASSERT_TRUE(ended);
  EXPECT_FALSE(alarms_.standing());
  EXPECT_EQ(ended->level, Alarm::Level::kAlarm);
  EXPECT_EQ(ended->begin, kStart + 2 * kWindow);
  EXPECT_EQ(ended->end, kStart + 4 * kWindow);
  EXPECT_TRUE(ended->over);
  EXPECT_EQ(ended->kind, Kind::kSilent);
  EXPECT_EQ(ended->culprit, "/b");
  EXPECT_EQ(ended->evidence, "overdue");
  EXPECT_EQ(ended->lowest_score, -2);
  EXPECT_EQ(ended->suspects.size(), 2U);
}

TEST_F(AlarmsTest, WhoIsNamedLaterChangesNeitherIdNorCulprit) {
  add(verdict(kAlarm, {suspect(0, Kind::kLate)}));
  const Alarm before = *alarms_.standing();
  Verdict second = verdict(kAlarm, {suspect(1, Kind::kSilent), suspect(0, Kind::kLate)});
  second.new_suspects = {suspect(1, Kind::kSilent)};
  add(second);
  const Alarm& after = *alarms_.standing();
  EXPECT_EQ(after.id, before.id);
  EXPECT_EQ(after.culprit, "/a");
  EXPECT_EQ(after.kind, Kind::kLate);
  EXPECT_EQ(after.suspects.size(), 1U);
  ASSERT_EQ(after.later.size(), 1U);
  EXPECT_EQ(after.later[0].component, "/b");
}

TEST_F(AlarmsTest, WhoComesWithLossesOrTooSeldomFellSilentForThat) {
  for (const Kind kind : {Kind::kLossy, Kind::kSlow}) {
    alarms_ = Alarms();
    add(verdict(kAlarm, {missing(0), missing(1)}));
    Suspect comes = suspect(0, kind);
    add(verdict(kAlarm, {comes}));
    EXPECT_EQ(alarms_.standing()->kind, Kind::kSilent) << "within its limit, it says nothing";
    comes.abnormal = true;
    comes.reason.words = "5 of 16 missing";
    add(verdict(kAlarm, {comes}));
    const Alarm alarm = *alarms_.standing();
    EXPECT_EQ(alarm.culprit, "/a");
    EXPECT_EQ(alarm.kind, kind);
    EXPECT_EQ(alarm.reason, "5 of 16 missing");
    EXPECT_EQ(alarm.suspects[1].reason.kind, Kind::kSilent);
  }
}

TEST_F(AlarmsTest, WhoWaitsForTheCulpritIsKeptWhereMostDid) {
  Verdict next = verdict(kAlarm, {suspect(0, Kind::kSilent)});
  for (const std::string waiting : {"", "/b waits for /a", "/c waits for /b, /b for /a", ""}) {
    next.waiting = waiting;
    add(next);
  }
  const std::string said = "/c waits for /b, /b for /a";
  EXPECT_EQ(alarms_.standing()->waiting, said);
  EXPECT_EQ(sentence(*alarms_.standing()).substr(sentence(*alarms_.standing()).find(';') + 2),
            said);
  next.suspects = {suspect(1, Kind::kSilent)};
  next.waiting = "/d waits for /c, and /c waits for /b";
  add(next);
  EXPECT_EQ(alarms_.standing()->waiting, said) << "of another one";
}

TEST_F(AlarmsTest, EveryAlarmAndSuspicionHasAnIdOfItsOwn) {
  add(verdict(kSuspicion, {suspect(0, Kind::kSlow)}));
  const std::uint64_t first = alarms_.standing()->id;
  EXPECT_EQ(first, static_cast<std::uint64_t>(kStart + kWindow)) << "the same live and from a bag";
  const std::optional<Alarm> suspicion = add(verdict(kAlarm, {suspect(0, Kind::kSlow)}));
  ASSERT_TRUE(suspicion);
  EXPECT_EQ(suspicion->id, first);
  EXPECT_EQ(suspicion->level, Alarm::Level::kSuspicion);
  const std::uint64_t second = alarms_.standing()->id;
  EXPECT_GT(second, first);
  add(verdict(kOk));
  window_.start = kStart;  // a recording is played again
  add(verdict(kAlarm, {suspect(0, Kind::kSlow)}));
  EXPECT_GT(alarms_.standing()->id, second);
}

TEST_F(AlarmsTest, ASuspicionThatAnAlarmLeavesIsAboutTheSame) {
  add(verdict(kAlarm, {suspect(1, Kind::kSlow)}));
  add(verdict(kSuspicion));
  EXPECT_EQ(alarms_.standing()->level, Alarm::Level::kSuspicion);
  expectBlamed("/b", Kind::kSlow);
  EXPECT_EQ(alarms_.standing()->evidence, "");
  ASSERT_EQ(alarms_.standing()->suspects.size(), 1U);
  EXPECT_EQ(alarms_.standing()->suspects[0].component, "/b");
  add(verdict(kSuspicion, {suspect(0, Kind::kFast)}));
  expectBlamed("/a", Kind::kFast);
}

TEST_F(AlarmsTest, WhereTheMachineIsBusyNobodyIsToBlame) {
  addBusy({12, 26});
  expectBlamed("", Kind::kBusyMachine);
  EXPECT_EQ(alarms_.standing()->busy->late, 12U);
  alarms_ = {};
  add(verdict(kAlarm, {suspect(1, Kind::kSilent)}));
  addBusy({12, 26});
  expectBlamed("", Kind::kBusyMachine);
  alarms_ = {};
  addBusy({12, 26}, {suspect(1, Kind::kSilent)});
  expectBlamed("/b", Kind::kSilent);  // it does not excuse who died
  EXPECT_TRUE(alarms_.standing()->busy);
}

TEST_F(AlarmsTest, WhatBeganBeforeAnExcuseStaysWhatItWas) {
  const std::int64_t later = kStart + 400 * kWindow;
  for (const bool mode : {false, true}) {
    alarms_ = {};
    add(verdict(kAlarm, {suspect(1, Kind::kSilent)}));
    addSilent({{}, {"/a", "/b"}, later, mode});
    expectBlamed("/b", Kind::kSilent);
  }
  alarms_ = {};
  add(verdict(kAlarm, {suspect(1, Kind::kSlow)}));
  addBusy({5, 9, 0, later});
  expectBlamed("/b", Kind::kSlow);
}

TEST_F(AlarmsTest, WhoIsDeadOnceTheMachineIsFreeIsToBlame) {
  addBusy({12, 26});
  EXPECT_EQ(alarms_.standing()->kind, Kind::kBusyMachine);
  Suspect dead = suspect(0, Kind::kSilent);
  add(verdict(kAlarm, {dead}));
  EXPECT_EQ(alarms_.standing()->kind, Kind::kBusyMachine) << "within its limit";
  dead.abnormal = true;
  add(verdict(kAlarm, {dead}));
  expectBlamed("/a", Kind::kSilent);
}

TEST_F(AlarmsTest, WhatElseIsSuspiciousIsToldOnceTheMachineIsFree) {
  Suspect stranger = missing(1);
  stranger.reason.kind = Kind::kStranger;
  for (const bool is_told_meanwhile : {false, true}) {
    Verdict busy = verdict(kSuspicion);
    busy.evidence = "busy";
    busy.busy = Busy{0, 3, 1.9, window_.start};
    add(busy);
    busy.new_suspects = {stranger};
    if (is_told_meanwhile) {
      add(busy);
    }
    expectBlamed("", Kind::kBusyMachine);
    const Suspect never = suspect(0, Kind::kNeverCame);
    add(verdict(kSuspicion, is_told_meanwhile ? std::vector<Suspect>{} : std::vector{never}));
    if (is_told_meanwhile) {
      expectBlamed("/b", Kind::kStranger);
    } else {
      expectBlamed("/a", Kind::kNeverCame);
    }
    add(verdict(kOk));
  }
}

TEST_F(AlarmsTest, WhoWasSilentFirstIsNotToBlameWhereAllAre) {
  add(verdict(kAlarm, {suspect(1, Kind::kSilent)}));
  EXPECT_EQ(alarms_.standing()->culprit, "/b");
  addSilent({{}, {"/a", "/b"}, kStart});
  expectBlamed("", Kind::kAllSilent);
  EXPECT_EQ(alarms_.standing()->reason, "everything fell silent: 2 components");
}

TEST_F(AlarmsTest, WhereSomeStoppedTogetherItIsANewModeAndNobodyIsToBlame) {
  add(verdict(kAlarm, {suspect(1, Kind::kSilent)}));
  Verdict mode = verdict(kSuspicion);
  mode.evidence = "new mode";
  mode.silent = Silent{{}, {"/a", "/b", "/c", "/d", "/e"}, kStart, true};
  add(mode);
  expectBlamed("", Kind::kNewMode);
  EXPECT_EQ(alarms_.standing()->reason,
            "/a, /b, /c and 2 more stopped together, and others go on: a mode that training did "
            "not show, or something that they share");
  add(verdict(kAlarm, {suspect(1, Kind::kSlow)}));
  EXPECT_EQ(alarms_.standing()->culprit, "/b") << "another one meanwhile";
}

TEST_F(AlarmsTest, WhoDiedOnAnotherComputerBeforeIsStillToBlame) {
  add(verdict(kAlarm, {suspect(1, Kind::kSilent)}));
  addSilent({{"base"}, {"/a", "/c"}, kStart});
  expectBlamed("/b", Kind::kSilent);
  EXPECT_EQ(alarms_.standing()->silent->hosts, std::vector<std::string>{"base"});
}

TEST_F(AlarmsTest, NamesStrangersAndTopicsWhereSourcesAreNotKnown) {
  EXPECT_FALSE(alarms_.end(kStart)) << "none stands";
  add(verdict(kSuspicion, {suspect(2, Kind::kStranger)}));
  EXPECT_EQ(alarms_.standing()->culprit, "/z");
  EXPECT_EQ(alarms_.standing()->suspects[0].component, "/z");
  std::optional<Alarm> ended = alarms_.end(kStart + 7);
  ASSERT_TRUE(ended && ended->over);
  EXPECT_EQ(ended->end, kStart + 7);
  EXPECT_FALSE(alarms_.standing());
  add(verdict(kSuspicion, {suspect(7, Kind::kStranger)}));
  EXPECT_EQ(alarms_.standing()->culprit, "") << "of that id nothing is known";
}

TEST_F(AlarmsTest, WhoWasMissedBeforeTheCulpritFailedIsToBlame) {
  const std::int64_t failed = kStart - kWindow;
  add(verdict(kAlarm, {silentSince(0, failed)}));
  add(verdict(kAlarm, {silentSince(1, failed - kWindow / 2), silentSince(0, failed)}));
  expectBlamed("/a", Kind::kSilent);  // the other one was not missed before
  add(verdict(kAlarm, {silentSince(0, failed), silentSince(1, failed - 2 * kWindow)}));
  expectBlamed("/a", Kind::kSilent);  // nor is it first
  add(verdict(kAlarm, {silentSince(1, failed - 2 * kWindow), silentSince(0, failed)}));
  expectBlamed("/b", Kind::kSilent);
}

TEST_F(AlarmsTest, WhoSlowedDownBeforeItsFollowerFellSilentIsToBlame) {
  const std::int64_t failed = kStart - kWindow;
  Suspect slow = suspect(1, Kind::kSlow);
  slow.abnormal = true;
  slow.onset = failed + kWindow;
  add(verdict(kAlarm, {silentSince(0, failed)}));
  add(verdict(kAlarm, {slow, silentSince(0, failed)}));
  expectBlamed("/a", Kind::kSilent);  // the other one was slow only afterwards
  slow.onset = failed - 10 * kWindow;
  add(verdict(kAlarm, {silentSince(0, failed), slow}));
  expectBlamed("/a", Kind::kSilent);  // nor is it first
  add(verdict(kAlarm, {slow}));
  expectBlamed("/a", Kind::kSilent);  // who is back did fail, whatever is left of its victims
  Suspect stranger = slow;
  stranger.reason.kind = Kind::kStranger;
  add(verdict(kAlarm, {stranger, silentSince(0, failed)}));
  expectBlamed("/a", Kind::kSilent);  // who was there before is not why
  add(verdict(kAlarm, {slow, silentSince(0, failed)}));
  expectBlamed("/b", Kind::kSlow);
}

TEST_F(AlarmsTest, WhoWasFastBeforeWhoFollowsItIsToBlame) {
  const auto fast = [](EventId id, std::int64_t onset) {
    Suspect fast = suspect(id, Kind::kFast);
    fast.abnormal = true;
    fast.onset = onset;
    return fast;
  };
  Suspect follower = fast(0, kStart);
  const Suspect before = fast(1, kStart - kWindow);
  add(verdict(kAlarm, {follower}));
  add(verdict(kAlarm, {before, follower}));
  expectBlamed("/a", Kind::kFast);  // it does not follow the other one
  follower.roots = {"/b"};
  add(verdict(kAlarm, {follower, before}));
  expectBlamed("/a", Kind::kFast);  // which is not first
  add(verdict(kAlarm, {fast(1, kStart + kWindow), follower}));
  expectBlamed("/a", Kind::kFast);  // or only since
  add(verdict(kAlarm, {before, follower}));
  expectBlamed("/b", Kind::kFast);
}

TEST_F(AlarmsTest, ANewModeThatIsOverDoesNotHideWhoIsStillSilent) {
  add(verdict(kAlarm, {suspect(1, Kind::kSilent)}));
  addSilent({{}, {"/a", "/b"}, kStart, true});
  expectBlamed("", Kind::kNewMode);
  add(verdict(kAlarm, {suspect(1, Kind::kSlow)}));
  expectBlamed("", Kind::kNewMode);  // who is back is unusual for a while
  add(verdict(kAlarm, {missing(1)}));
  expectBlamed("/b", Kind::kSilent);
}

TEST_F(AlarmsTest, AnAlarmOfBeforeTheStartKeepsItsIdAndItsCulprit) {
  Alarm before;
  before.id = 1ULL << 60;  // later than all that follows
  before.level = Alarm::Level::kAlarm;
  before.culprit = "/b";
  before.evidence = "overdue";
  alarms_.resume(before);
  EXPECT_FALSE(add(verdict(kAlarm, {suspect(0, Kind::kSlow)})));
  ASSERT_TRUE(alarms_.standing());
  EXPECT_EQ(alarms_.standing()->id, before.id);
  EXPECT_EQ(alarms_.standing()->culprit, "/b");
  const std::optional<Alarm> ended = add(verdict(kOk));
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->id, before.id);
  add(verdict(kAlarm, {suspect(0, Kind::kSilent)}));
  EXPECT_EQ(alarms_.standing()->id, before.id + 1);
}

}  // namespace
}  // namespace self_awareness::core
