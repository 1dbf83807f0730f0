#include "self_awareness/core/verdict/incident.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace self_awareness::core {
namespace {

using Names = std::vector<std::string>;
constexpr std::int64_t kSecond = 1000000000;
constexpr std::int64_t kRepeats = 600 * kSecond;

class IncidentsTest : public testing::Test {
 protected:
  /// An alarm that names components; the first is the culprit. Its id is its begin.
  static Occurrence alarm(std::int64_t begin, std::int64_t end, const Names& named,
                          bool over = true) {
    Occurrence occurrence;
    occurrence.id = static_cast<std::uint64_t>(begin);
    occurrence.level = Alarm::Level::kAlarm;
    occurrence.begin = begin * kSecond;
    occurrence.end = end * kSecond;
    occurrence.over = over;
    occurrence.culprit = named.empty() ? "" : named.front();
    for (const std::string& name : named) {
      occurrence.named.push_back({name, true, occurrence.begin, std::nullopt});
    }
    return occurrence;
  }
  static Occurrence suspicion(std::int64_t begin, std::int64_t end, const Names& named) {
    Occurrence occurrence = alarm(begin, end, named);
    occurrence.level = Alarm::Level::kSuspicion;
    return occurrence;
  }
  void add(const Occurrence& occurrence) { incidents_.add(occurrence, graph_); }
  std::vector<Incident> list() const { return incidents_.list(graph_); }
  /// The only one.
  Incident one() const {
    EXPECT_EQ(list().size(), 1U);
    return list().empty() ? Incident{} : list().front();
  }

  SourceGraph graph_;
  Incidents incidents_{kRepeats, 4};
};

TEST_F(IncidentsTest, AnAlarmOpensAnIncidentThatGrowsAndIsOver) {
  graph_.connect("/player", "/scan", "/slam");
  graph_.connect("/slam", "/pose", "/navigation");
  Occurrence stands = alarm(10, 11, {"/player", "/slam"}, false);
  stands.reason = "silent for 1 s";
  add(stands);
  EXPECT_EQ(one().id, 10U);
  EXPECT_EQ(one().cause, "/player");
  EXPECT_EQ(one().reason, "silent for 1 s");
  EXPECT_EQ(one().victims, Names{"/slam"});
  EXPECT_FALSE(one().over);
  EXPECT_EQ(one().grown, 10 * kSecond);
  stands.named.push_back({"/navigation", true, 14 * kSecond, std::nullopt});
  stands.named.push_back({"/camera", false, 15 * kSecond, std::nullopt});
  add(stands);
  EXPECT_EQ(one().victims, (Names{"/slam", "/navigation"}));
  EXPECT_EQ(one().others, Names{"/camera"});
  EXPECT_EQ(one().grown, 15 * kSecond);
  stands.over = true;
  stands.end = 20 * kSecond;
  add(stands);
  EXPECT_TRUE(one().over);
  EXPECT_EQ(one().end, 20 * kSecond);
  EXPECT_EQ(one().alarms, 1U);
}

TEST_F(IncidentsTest, WithoutACulpritTheKindAndItsComputersAreTheCause) {
  const auto add_of = [&](std::int64_t begin, Kind kind, const Names& hosts) {
    Occurrence of_nobody = alarm(begin, begin + 5, {});
    of_nobody.kind = kind;
    of_nobody.hosts = hosts;
    add(of_nobody);
  };
  add_of(10, Kind::kBusyMachine, {});
  add_of(40, Kind::kAllSilent, {"base"});
  add_of(70, Kind::kAllSilent, {"arm"});
  add_of(100, Kind::kAllSilent, {"base"});
  add_of(130, Kind::kBusyMachine, {});
  ASSERT_EQ(list().size(), 3U);
  EXPECT_EQ(list()[0].alarms, 2U);
  EXPECT_EQ(list()[1].hosts, Names{"base"});
  EXPECT_EQ(list()[1].alarms, 2U);
  EXPECT_EQ(list()[2].hosts, Names{"arm"});
}

TEST_F(IncidentsTest, OfANewModeAllWhoStoppedAreKept) {
  Alarm mode;
  mode.id = 10;
  mode.kind = Kind::kNewMode;
  mode.begin = 10 * kSecond;
  mode.silent.emplace();
  mode.silent->others_go_on = true;
  mode.silent->components = {"/a", "/b", "/c", "/d"};
  add(occurrenceOf(mode));
  EXPECT_EQ(one().together, mode.silent->components);
  EXPECT_TRUE(one().others.empty());
  mode.silent->components.push_back("/e");
  mode.over = true;
  add(occurrenceOf(mode));
  EXPECT_EQ(one().together, mode.silent->components);
}

TEST_F(IncidentsTest, StrangersAndWhoLosesMessagesOverOneLinkAreTogetherWithTheirKindOnly) {
  graph_.connect("/player", "/scan", "/slam");
  for (const Kind kind : {Kind::kStranger, Kind::kLossy}) {
    incidents_ = Incidents(kRepeats, 4);
    Occurrence flood = alarm(10, 15, {"/new", "/newer", "/camera"});
    flood.named[0].kind = flood.named[1].kind = kind;
    flood.named[2].kind = Kind::kSlow;
    add(flood);
    EXPECT_EQ(one().together, Names{"/newer"});
    EXPECT_EQ(one().others, Names{"/camera"});
    graph_ = {};  // of a link, none is needed
  }
}

TEST_F(IncidentsTest, WhatIsWrongWithOthersOrBeganLaterIsNotTheSame) {
  graph_.connect("/player", "/scan", "/slam");
  Occurrence fast = alarm(10, 60, {"/battery", "/wifi", "/imu", "/gps"});
  for (Occurrence::Named& named : fast.named) {
    named.kind = Kind::kFast;
    named.onset = 9 * kSecond;
  }
  fast.named[2].kind = Kind::kStale;
  fast.named[3].onset = 40 * kSecond;
  add(fast);
  EXPECT_EQ(one().together, Names{"/wifi"});
  EXPECT_EQ(one().others, (Names{"/imu", "/gps"}));
}

TEST_F(IncidentsTest, SevenRestartsInTenMinutesAreOne) {
  for (std::int64_t i = 0; i < 7; ++i) {
    add(alarm(80 * i, 80 * i + 5, {"/player"}));
  }
  EXPECT_EQ(one().alarms, 7U);
  EXPECT_EQ(one().id, 0U);
  EXPECT_EQ(one().last, 480U);
  EXPECT_EQ(one().ids.size(), 7U);
  add(alarm(1085, 1090, {"/player"}));
  EXPECT_EQ(one().alarms, 8U) << "ten minutes after the last one";
  add(alarm(1691, 1692, {"/player"}));
  ASSERT_EQ(list().size(), 2U);
  EXPECT_EQ(list().back().id, 1691U);
}

TEST_F(IncidentsTest, OthersAreOtherIncidents) {
  add(alarm(10, 12, {"/a"}));
  add(alarm(13, 15, {"/b"}));
  EXPECT_EQ(list().size(), 2U) << "soon, but nobody in common";
  add(alarm(16, 18, {"/c", "/b"}));
  ASSERT_EQ(list().size(), 2U) << "of the episode of /b";
  EXPECT_EQ(list().back().cause, "/b");
  EXPECT_EQ(list().back().others, Names{"/c"});
}

TEST_F(IncidentsTest, ASuspicionBecomesTheAlarmAfterIt) {
  add(suspicion(10, 11, {"/victim", "/quiet", "/root"}));
  EXPECT_EQ(one().cause, "/victim");
  EXPECT_EQ(one().near_misses, 1U);
  add(alarm(11, 20, {"/root", "/victim"}));
  EXPECT_EQ(one().cause, "/root");
  EXPECT_EQ(one().id, 11U);
  EXPECT_EQ(one().near_misses, 0U);
  EXPECT_EQ(one().others, Names{"/victim"}) << "what a suspicion names is less sure";
  add(suspicion(20, 22, {"/root"}));
  EXPECT_EQ(one().near_misses, 0U) << "what the alarm leaves";
}

TEST_F(IncidentsTest, NearMissesAreCounted) {
  for (std::int64_t i = 0; i < 5; ++i) {
    add(suspicion(20 * i, 20 * i + 2, {"/a"}));
  }
  EXPECT_EQ(one().level, Alarm::Level::kSuspicion);
  EXPECT_EQ(one().near_misses, 5U);
  EXPECT_EQ(one().alarms, 0U);
  add(alarm(200, 210, {"/a"}));
  EXPECT_EQ(one().level, Alarm::Level::kAlarm);
  EXPECT_EQ(one().id, 200U);
  EXPECT_EQ(one().opened, 200 * kSecond);
  EXPECT_EQ(one().near_misses, 5U);
  add(suspicion(300, 301, {"/a", "/b"}));
  EXPECT_EQ(one().near_misses, 6U);
  EXPECT_TRUE(one().others.empty());
}

TEST_F(IncidentsTest, WhoFallsSilentAtOnceFailedTogether) {
  Occurrence dead = alarm(10, 20, {"/a", "/b", "/c", "/d"});
  for (std::size_t i = 0; i < 3; ++i) {
    dead.named[i].silent_since = 9 * kSecond + static_cast<std::int64_t>(i) * kSecond / 2;
  }
  add(dead);
  EXPECT_EQ(one().together, (Names{"/b", "/c"}));
  EXPECT_EQ(one().others, Names{"/d"});
  dead.begin += 50 * kSecond;
  dead.end += 60 * kSecond;
  dead.id = 60;
  graph_.connect("/a", "/t", "/b");
  graph_.connect("/b", "/rosout", "/d");
  add(dead);
  EXPECT_EQ(one().together, Names{"/c"}) << "the longest alarm tells";
  EXPECT_EQ(one().victims, Names{"/b"});
  EXPECT_EQ(one().others, Names{"/d"}) << "nobody needs a log";
}

TEST_F(IncidentsTest, WhoNeedsAnotherOneThatFailedIsItsVictim) {
  graph_.connect("/lidar", "/scan", "/planner");
  graph_.connect("/planner", "/plan", "/controller");
  graph_.connect("/controller", "/state", "/planner");
  Occurrence stands = alarm(10, 11, {"/battery"}, false);
  for (const std::string name : {"/lidar", "/planner", "/controller", "/camera"}) {
    stands.named.push_back({name, true, 14 * kSecond, 14 * kSecond});
    add(stands);
  }
  EXPECT_EQ(one().cause, "/battery");
  EXPECT_EQ(one().others, (Names{"/lidar", "/camera"}));
  EXPECT_EQ(one().victims, (Names{"/planner", "/controller"}));
}

TEST_F(IncidentsTest, AnotherAlarmEndsTheOneBefore) {
  add(alarm(10, 11, {"/a"}, false));
  add(alarm(50, 51, {"/b"}, false));
  ASSERT_EQ(list().size(), 2U);
  EXPECT_TRUE(list().front().over);
  EXPECT_EQ(list().front().end, 50 * kSecond);
  EXPECT_FALSE(list().back().over);
}

TEST_F(IncidentsTest, TheOldestMakeRoomNearMissesFirst) {
  add(alarm(0, 1, {"/a"}));
  add(suspicion(1000, 1001, {"/b"}));
  for (std::int64_t i = 2; i < 5; ++i) {
    add(alarm(1000 * i, 1000 * i + 1, {"/c"}));
  }
  ASSERT_EQ(list().size(), 4U);
  EXPECT_EQ(list().front().cause, "/a");
  EXPECT_EQ(list()[1].id, 2000U);
  add(alarm(5000, 5001, {"/c"}));
  EXPECT_EQ(list().front().id, 2000U);
}

TEST_F(IncidentsTest, AnotherStartGoesOnWithWhatStands) {
  add(alarm(0, 5, {"/b"}));
  add(alarm(10, 12, {"/a"}));
  add(alarm(100, 101, {"/a", "/victim"}, false));
  Incidents started(kRepeats, 4);
  started.restore(list());
  // The alarm of before the start: who it named is not known any more.
  Occurrence standing = alarm(100, 130, {"/a"}, false);
  standing.named.clear();
  started.add(standing, graph_);
  ASSERT_EQ(started.list(graph_).size(), 2U);
  const Incident incident = started.list(graph_).back();
  EXPECT_EQ(incident.id, 10U);
  EXPECT_EQ(incident.alarms, 2U) << "it is the same alarm";
  EXPECT_EQ(incident.others, Names{"/victim"});
  EXPECT_FALSE(incident.over);
}

TEST_F(IncidentsTest, WhatIsKnownNoMoreIsKnownAgainWhenItIsRaised) {
  add(alarm(10, 12, {"/a"}));
  std::vector<Incident> before = list();
  before[0].unknown = true;
  Incidents started(kRepeats, 4);
  started.restore(before);
  EXPECT_TRUE(started.list(graph_).at(0).unknown);
  started.add(alarm(13, 14, {"/a"}), graph_);
  ASSERT_EQ(started.list(graph_).size(), 1U);
  EXPECT_FALSE(started.list(graph_)[0].unknown);
}

TEST_F(IncidentsTest, MemoryIsBounded) {
  Names many{"/root"};
  for (int i = 0; i < 120; ++i) {
    many.push_back("/n" + std::to_string(i));
  }
  for (std::int64_t i = 0; i < 1100; ++i) {
    add(alarm(3 * i, 3 * i + 1, many));
  }
  EXPECT_EQ(one().others.size(), Incident::kMostNamed);
  EXPECT_EQ(one().ids.size(), Incident::kMostIds);
  EXPECT_EQ(one().alarms, 1100U);
}

TEST(OccurrenceOf, AnAlarmTellsSinceWhenWhoIsSilent) {
  Suspect dead;
  dead.component = "/a";
  dead.onset = 8 * kSecond;
  Suspect slow = dead;
  slow.component = "/b";
  slow.reason.kind = Kind::kSlow;
  Alarm alarm;
  alarm.suspects = {dead};
  alarm.later = {slow};
  const Occurrence occurrence = occurrenceOf(alarm);
  ASSERT_EQ(occurrence.named.size(), 2U);
  EXPECT_EQ(occurrence.named[0].silent_since, dead.onset);
  EXPECT_EQ(occurrence.named[1].silent_since, std::nullopt);
}

}  // namespace
}  // namespace self_awareness::core
