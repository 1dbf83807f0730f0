#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

#include "../../verdict/accepted.h"
#include "../judged.h"
#include "self_awareness/core/evidence/judge.h"
#include "stopped.h"

namespace self_awareness::core::evidence {
namespace {

const std::vector<EventType> kRobot{{"/wheels", "/odom", "T"}, {"/laser", "/scan", "T"},
                                    {"/arm", "/joints", "T"},  {"/lidar", "/cloud", "T"},
                                    {"/slam", "/pose", "T"},   {"/imu", "/imu/data", "T"}};
constexpr EventId kSlam = 4;
constexpr EventId kImu = 5;

Events robot(std::int64_t start, unsigned seed) {
  return atRandom(kRobot.size(), start, kEnd, 100 * kMillisecond, seed);
}

class NewModeTest : public StoppedTest {
 protected:
  NewModeTest() : StoppedTest(kRobot) {
    graph_->connect("/laser", "/scan", "/slam");
    learn(robot);
  }
  std::optional<Silent> excuse(const std::vector<std::int64_t>& ages, std::int64_t now = kEnd) {
    return found(ages, now).silent;
  }
  /// Whether that is a mode which is accepted.
  bool isNormal(const std::vector<std::int64_t>& ages, std::int64_t now = kEnd) {
    return !found(ages, now).mode.empty();
  }
  void accept(const Strings& together) { together_->accept(allOf({acceptedMode(together)})); }
};

TEST_F(NewModeTest, NobodyIsToBlameWhereFourThatDoNotHearEachOtherStopTogether) {
  const std::optional<Silent> silent = excuse({kAgo, kAgo, kAgo + kSecond / 50, kAgo, 0, 0});
  ASSERT_TRUE(silent);
  EXPECT_TRUE(silent->others_go_on);
  EXPECT_EQ(silent->components, (Strings{"/arm", "/laser", "/lidar", "/wheels"}));
  EXPECT_EQ(silent->since, kEnd - kAgo);
  EXPECT_EQ(shares_, std::vector<double>(shares_.size(), 0));
}

TEST_F(NewModeTest, WhoWasMissedWhenTheOthersCameLastDiedBeforeThem) {
  const std::optional<Silent> silent = excuse({kAgo, kAgo, kAgo + kSecond, kAgo, 0, kAgo});
  ASSERT_TRUE(silent);
  EXPECT_EQ(silent->components, (Strings{"/imu", "/laser", "/lidar", "/wheels"}));
  EXPECT_EQ(share(2), 2) << "a mode does not hide a death";
  EXPECT_EQ(share(0), 0);
}

TEST_F(NewModeTest, WhoseVictimWasMissedBeforeTheOthersStoppedDiedBeforeThem) {
  const std::vector<std::int64_t> ages{kAgo, kAgo + kSecond / 50, kAgo,
                                       kAgo, kAgo + kSecond / 50, 0};
  EXPECT_TRUE(excuse(ages));
  beginAnew();
  abnormal_[kSlam] = kEnd - kAgo - kMillisecond;
  EXPECT_FALSE(excuse(ages)) << "the other three are too few";
  EXPECT_EQ(share(1), 2);
}

TEST_F(NewModeTest, FourThatStopAtOneTimeAreExcusedWithTheirVictims) {
  struct Case {
    std::string what;
    std::vector<std::int64_t> ages;
    bool is_mode;
    EventId of;
    double share;
  };
  for (const Case& each : std::vector<Case>{
           {"three are faults", {kAgo, kAgo, kAgo, 0, 0, 0}, false, 0, 2},
           {"a victim is none of the four", {kAgo, kAgo, kAgo, 0, kAgo, 0}, false, 0, 2},
           {"but excused with them", {kAgo, kAgo, kAgo, kAgo, kAgo, 0}, true, kSlam, 0},
           {"also one that stops later", {kAgo, kAgo, kAgo, kAgo, kAgo / 2, 0}, true, kSlam, 0},
           {"not before, though it hears", {kAgo, kAgo, kAgo, kAgo, 2 * kAgo, 0}, true, kSlam, 2},
           {"nor who hears none of them", {kAgo, kAgo, kAgo, kAgo, 0, kAgo / 2}, true, kImu, 2},
           {"nor are they four then", {kAgo, kAgo, kAgo, 0, 0, kAgo / 2}, false, kImu, 2},
           {"where nobody is heard since, all are silent",
            {kAgo, kAgo, kAgo, kAgo, kAgo - kSecond, kAgo - 2 * kSecond},
            false,
            0,
            2}}) {
    EXPECT_EQ(excuse(each.ages).has_value(), each.is_mode) << each.what;
    EXPECT_EQ(share(each.of), each.share) << each.what;
    together_->restart();
  }
}

TEST_F(NewModeTest, WhoMayBeSilentIsNoneOfTheFour) {
  moment_->may_be_silent[2] = true;
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
  EXPECT_EQ(share(0), 2);
  const std::optional<Silent> silent = excuse({kAgo, kAgo, kAgo, kAgo, 0, kAgo});
  ASSERT_TRUE(silent);
  EXPECT_EQ(silent->components, (Strings{"/imu", "/laser", "/lidar", "/wheels"}));
}

TEST_F(NewModeTest, WhatWasAModeBeforeAllFellSilentStaysOne) {
  const std::optional<Silent> silent = excuse({kAgo, kAgo, kAgo, kAgo, 5 * kSecond, 5 * kSecond});
  ASSERT_TRUE(silent);
  EXPECT_FALSE(silent->others_go_on);
  EXPECT_EQ(silent->components, (Strings{"/imu", "/slam"}));
  EXPECT_EQ(share(0), 0) << "nor is who stopped before to blame";
}

TEST_F(NewModeTest, TheGraphMayGrow) {
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
  together_->restart();
  graph_->connect("/wheels", "/odom", "/arm");
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
}

TEST_F(NewModeTest, WithoutAGraphTheyMayBeVictims) {
  graph_ = std::make_shared<SourceGraph>();
  beginAnew();
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
}

TEST_F(NewModeTest, WhoComesBackLastIsExcusedForAMoment) {
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
  EXPECT_TRUE(excuse({kAgo + kSecond, 0, 0, 0, 0, 0}, kEnd + kSecond));
  EXPECT_EQ(share(0), 0);
  EXPECT_FALSE(excuse({kAgo + 4 * kSecond, 0, 0, 0, 0, 0}, kEnd + 4 * kSecond));
  EXPECT_EQ(share(0), 2);
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
  together_->restart();
  EXPECT_FALSE(excuse({kAgo + kSecond, 0, 0, 0, 0, 0}, kEnd + kSecond)) << "after a restart";
}

TEST_F(NewModeTest, WhatIsAcceptedIsNormal) {
  EXPECT_FALSE(isNormal({kAgo, kAgo, kAgo, kAgo, 0, 0})) << "it is not yet";
  accept({"/arm", "/laser", "/lidar", "/slam", "/wheels"});
  EXPECT_TRUE(isNormal({kAgo, kAgo, kAgo, kAgo, 0, 0}));
  EXPECT_EQ(shares_, std::vector<double>(shares_.size(), 0));
  EXPECT_TRUE(isNormal({kAgo, kAgo, kAgo, kAgo, kAgo, 0}));
  EXPECT_TRUE(isNormal({kAgo + kSecond, 0, 0, 0, 0, 0}, kEnd + kSecond)) << "it comes back last";
  EXPECT_EQ(share(0), 0);
}

TEST_F(NewModeTest, WhoGoesOnInAnAcceptedModeIsJudged) {
  constexpr std::int64_t kBegan = 90 * kSecond;
  accept({"/arm", "/laser", "/lidar", "/wheels"});
  EXPECT_TRUE(isNormal({kBegan, kBegan, kBegan, kBegan, 40 * kSecond, 0}));
  EXPECT_EQ(share(kSlam), 0) << "it hears /laser, and has stopped within a minute";
  EXPECT_TRUE(isNormal({kBegan, kBegan, kBegan, kBegan, 5 * kSecond, 0}));
  EXPECT_EQ(share(kSlam), 2) << "it went on without /laser";
  EXPECT_EQ(share(0), 0);
}

TEST_F(NewModeTest, AnotherFaultInAnAcceptedModeIsNoNewMode) {
  accept({"/arm", "/laser", "/lidar", "/wheels"});
  const std::vector<std::int64_t> imu_died{kAgo, kAgo, kAgo, kAgo, 0, kAgo / 2};
  EXPECT_TRUE(isNormal(imu_died));
  EXPECT_EQ(share(kImu), 2);
  EXPECT_FALSE(excuse(imu_died));
  EXPECT_EQ(share(kImu), 2);
}

TEST_F(NewModeTest, AnAcceptedModeDoesNotHideThatAllFellSilent) {
  accept({"/arm", "/laser", "/lidar", "/wheels"});
  const Judgement judgement = found({kAgo, kAgo, kAgo, kAgo, kAgo, kAgo});
  ASSERT_TRUE(judgement.silent);
  EXPECT_FALSE(judgement.silent->others_go_on);
  EXPECT_EQ(judgement.silent->components.size(), kRobot.size());
  EXPECT_EQ(excused_, std::vector<Excused>(kRobot.size(), Excused::kAllSilent));
}

TEST_F(NewModeTest, WhenAnAcceptedModeBeginsTheFirstOneMissedIsNotDead) {
  constexpr std::int64_t kGap = 100 * kMillisecond;
  accept({"/arm", "/laser", "/lidar", "/wheels"});
  EXPECT_TRUE(isNormal({30 * kGap, 29 * kGap, 28 * kGap, 27 * kGap, 0, 0}));
  together_->restart();
  const std::vector<std::int64_t> begun{10 * kGap, 9 * kGap, kGap / 10, kGap / 10, 0, 0};
  EXPECT_FALSE(isNormal(begun)) << "two were heard since";
  EXPECT_EQ(share(0), 2);
  EXPECT_TRUE(isNormal({15 * kGap, 14 * kGap, 15 * kGap, 14 * kGap, 0, 0}));
  EXPECT_EQ(share(0), 0);
}

TEST_F(NewModeTest, ADeathAndAnotherModeAreNotAccepted) {
  accept({"/arm", "/laser", "/lidar", "/wheels"});
  for (const std::vector<std::int64_t>& faults :
       {std::vector<std::int64_t>{kAgo, 0, 0, 0, 0, 0}, {kAgo, kAgo, kAgo, 0, 0, 0}}) {
    EXPECT_FALSE(isNormal(faults));
    EXPECT_EQ(share(0), 2);
    together_->restart();
  }
  EXPECT_FALSE(isNormal({kAgo, kAgo, kAgo, 0, 0, kAgo}));
  together_->restart();
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, kAgo})) << "that of more is new";
}

TEST_F(NewModeTest, AnAcceptedOneIsNeitherSuspiciousNorAShareOfALimit) {
  const Strings stopping{"/arm", "/laser", "/lidar", "/wheels"};
  Limits limits = allLimits(*model_, kNone);
  Events events;
  for (EventId id = 0; id < kRobot.size(); ++id) {
    ofTrack(limits.tracks, *model_, kOverdue, id) = 2;
    const std::int64_t end = id < stopping.size() ? 20 * kSecond : 40 * kSecond;
    events = together({events, timer(id, 0, end, 100 * kMillisecond)});
  }
  for (const bool is_accepted : {false, true}) {
    double largest = 0;  // share that was told
    std::optional<std::int64_t> unusual;
    Strings mode;
    std::unique_ptr<core::Judge> asked = makeJudge(
        model_, limits, kWindow, graph_, nullptr, [&](const Window&, const Shares& shares) {
          largest =
              std::max(largest, *std::max_element(shares.tracks.begin(), shares.tracks.end()));
        });
    asked->accept(is_accepted ? allOf({acceptedMode(stopping)}) : Acceptances{});
    judge(std::move(asked), events, [&](const Verdict& verdict) {
      if (!unusual && (verdict.abnormal || verdict.suspicion || verdict.silent)) {
        unusual = verdict.window->start;
      }
      mode = verdict.mode;
    });
    EXPECT_EQ(unusual.has_value(), !is_accepted);
    EXPECT_LT(unusual.value_or(0), 23 * kSecond);
    EXPECT_EQ(largest > 1, !is_accepted);
    EXPECT_EQ(mode, is_accepted ? stopping : Strings{});
  }
}

// Nine that do not hear each other, but for the last one, which hears the first one.
class NewModesTest : public StoppedTest {
 protected:
  NewModesTest() : StoppedTest(numberedTypes(9)) {
    graph_->connect(types_[0].source, types_[0].scope, types_[8].source);
    learn([](std::int64_t start, unsigned seed) {
      return atRandom(9, start, kEnd, 100 * kMillisecond, seed);
    });
  }
};

TEST_F(NewModesTest, WhoStoppedFirstStaysExcusedWhenOthersStopTogether) {
  constexpr std::int64_t kBefore = 60 * kSecond;
  const std::optional<Silent> silent =
      found({kBefore, kBefore, kBefore, kBefore, kAgo, kAgo, kAgo, kAgo, 0}).silent;
  ASSERT_TRUE(silent);
  EXPECT_EQ(silent->components.size(), 8U);
  EXPECT_EQ(shares_, std::vector<double>(shares_.size(), 0));
}

// A client that asks a server, and four more that do not hear each other.
class NewModeOfServersTest : public StoppedTest {
 protected:
  NewModeOfServersTest()
      : StoppedTest({{"/client", "/request", "T"},
                     {"/server", "/answer", "T"},
                     {"/a", "/a/out", "T"},
                     {"/b", "/b/out", "T"},
                     {"/c", "/c/out", "T"},
                     {"/d", "/d/out", "T"}}) {
    graph_->connect("/client", "/request", "/server");
    graph_->connect("/server", "/answer", "/client");
    learn(
        [](std::int64_t start, unsigned seed) {
          const Events all = atRandom(6, start, 4 * kEnd, kSecond, seed);
          const Events asked = without(all, [](const Event& event) { return event.id != 0; });
          return together({without(all, [](const Event& event) { return event.id == kServer; }),
                           answers(kServer, asked, 20 * kMillisecond)});
        },
        *graph_);
  }
  static constexpr EventId kServer = 1;
};

TEST_F(NewModeOfServersTest, WhoOwesAnAnswerIsNotInANewMode) {
  ASSERT_TRUE(isWatched(model_->tracks(), kDeadlines, kServer, 0));
  const Scorer scorer = heardLast(model_, {0, kAgo, kAgo, kAgo, kAgo, kAgo}, kEnd);
  for (const double owed : {0.5, 2.0}) {
    beginAnew();
    for (EventId id = 1; id < types_.size(); ++id) {
      share(id) = 2;
    }
    ofTrack(shares_, *model_, kDeadlines, kServer, 0) = owed;
    const std::optional<Silent> silent = excuseIn(scorer).silent;
    ASSERT_TRUE(silent);
    EXPECT_EQ(silent->has("/server"), owed < 1);
    EXPECT_EQ(share(kServer), owed < 1 ? 0 : 2);
  }
}

// A planner that is heard every 30 s, too seldom to be judged, and controllers that need it.
class RootWithoutTrackTest : public StoppedTest {
 protected:
  RootWithoutTrackTest() : StoppedTest(numberedTypes(6)) {
    for (EventId id = 1; id < kAlive; ++id) {
      graph_->connect(types_[0].source, types_[0].scope, types_[id].source);
    }
    learn([](std::int64_t start, unsigned seed) {
      const Events all = atRandom(6, start, kEnd, 100 * kMillisecond, seed);
      return together({timer(0, start, start + kEnd, 30 * kSecond),
                       without(all, [](const Event& event) { return event.id == 0; })});
    });
  }
  /// Whether controllers that stopped kAgo are excused.
  /// @param planner when that was heard last [ns]
  bool isExcused(std::int64_t planner) {
    beginAnew();
    for (EventId id = 1; id < kAlive; ++id) {
      share(id) = 2;
    }
    return excuseIn(heardLast(model_, {kEnd - planner, kAgo, kAgo, kAgo, kAgo, 0}, kEnd))
        .silent.has_value();
  }
  static constexpr EventId kAlive = 5;
};

TEST_F(RootWithoutTrackTest, WhoWasNotHeardSinceMayHaveDiedUnlessItWasSilentForLongBefore) {
  ASSERT_FALSE(isWatched(model_->tracks(), kOverdue, 0, 0));
  EXPECT_FALSE(isExcused(kEnd - kAgo - 10 * kMillisecond));
  EXPECT_FALSE(isExcused(kEnd - kAgo - 30 * kSecond)) << "for as long as it usually waits";
  EXPECT_TRUE(isExcused(kEnd - kAgo - 33 * kSecond));
  EXPECT_TRUE(isExcused(kEnd - kAgo + kMillisecond)) << "it is alive";
}

// Five that run in sessions only, and an IMU that always does.
class CompanyOfOthersTest : public StoppedTest {
 protected:
  CompanyOfOthersTest() : StoppedTest(kRobot) {
    graph_->connect("/laser", "/scan", "/slam");
    learn([](std::int64_t start, unsigned seed) {
      constexpr std::int64_t kGap = 100 * kMillisecond;
      Events events = irregular(kImu, start, start + kEnd, kGap, seed + kImu);
      for (std::int64_t session = start; session < start + kEnd; session += 20 * kSecond) {
        events = together({events, atRandom(kImu, session, 10 * kSecond, kGap, seed)});
      }
      return events;
    });
  }
};

TEST_F(CompanyOfOthersTest, ThatGoesOnMakesThemNoFaultEither) {
  constexpr std::int64_t kBefore = 3 * kSecond;
  Scorer scorer(model_, kWindow);
  for (EventId id = 0; id < kSlam; ++id) {
    scorer.add({kEnd - kBefore, id});
  }
  for (std::int64_t stamp = kEnd - kBefore; stamp < kEnd; stamp += 100 * kMillisecond) {
    scorer.add({stamp, kSlam});
    scorer.add({stamp, kImu});
  }
  scorer.closeWindow(kEnd);
  std::size_t beyond = 0;
  for (std::size_t track = 0; track < shares_.size(); ++track) {
    const Track& watched = model_->tracks()[track];
    if (channelName(watched) == kCompany && watched.to < kSlam) {
      shares_[track] = 2;
      ++beyond;
    }
  }
  ASSERT_GE(beyond, 4U);
  const std::optional<Silent> found = excuseIn(scorer).silent;
  ASSERT_TRUE(found);
  EXPECT_EQ(found->components, (Strings{"/arm", "/laser", "/lidar", "/wheels"}));
  EXPECT_EQ(shares_, std::vector<double>(shares_.size(), 0));
}

// 150 topics of 60 nodes, which all hear a root, and one that hears nobody.
class NewModeOfALargeRobotTest : public StoppedTest {
 protected:
  NewModeOfALargeRobotTest() : StoppedTest(types()) {
    for (EventId id = 0; id < kRoot; ++id) {
      const EventId node = id % kNodes;
      graph_->connect(name(node / 2), types_[node / 2].scope, name(node));
      graph_->connect(name(node), types_[id].scope, name((7 * node + id) % kNodes));
      graph_->connect("/root", "/root/out", name(node));
    }
    Tuning tuning;
    tuning.without = {kPairs, kSlower, kFaster, kDeadlines};
    learn(running, *graph_, tuning);
  }
  static std::string name(EventId node) { return "/c" + std::to_string(node); }
  static std::vector<EventType> types() {
    std::vector<EventType> types;
    for (EventId id = 0; id < kRoot; ++id) {
      types.push_back({name(id % kNodes), "/t" + std::to_string(id), "T"});
    }
    types.push_back({"/root", "/root/out", "T"});
    types.push_back({"/alive", "/alive/out", "T"});
    return types;
  }
  static Events running(std::int64_t start, unsigned /*seed*/) {
    Events events;
    for (EventId id = 0; id <= kRoot + 1; ++id) {
      events = together({events, timer(id, start, start + 20 * kSecond, 200 * kMillisecond)});
    }
    return events;
  }
  static constexpr EventId kNodes = 60;
  static constexpr EventId kRoot = 150;
};

TEST_F(NewModeOfALargeRobotTest, TakesLittleTimeWhileAllWaitForOneThatDied) {
  constexpr int kWindows = 20;
  std::vector<std::int64_t> ages(kRoot + 1, 20 * kSecond);
  ages.push_back(0);
  const Scorer scorer = heardLast(model_, ages, 40 * kSecond);
  for (EventId id = 0; id <= kRoot; ++id) {
    share(id) = 2;
  }
  const std::clock_t begin = std::clock();
  for (int window = 0; window < kWindows; ++window) {
    EXPECT_FALSE(excuseIn(scorer).silent);
  }
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / kWindows, 0.01);
}

}  // namespace
}  // namespace self_awareness::core::evidence
