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
  using Ages = std::vector<std::int64_t>;
  struct Case {
    std::string what;
    Ages ages;
    bool is_mode;
    EventId of;
    double share;
  };

  std::optional<Silent> excuse(const Ages& ages, std::int64_t now = kEnd) {
    return found(ages, now).silent;
  }
  /// Whether that is a mode which is accepted.
  bool isNormal(const Ages& ages, std::int64_t now = kEnd) {
    return !found(ages, now).mode.empty();
  }
  /// Accepts that the four stop together.
  void accept() { together_->accept(allOf({acceptedMode(four_)})); }
  void expect(const std::vector<Case>& cases, bool is_accepted) {
    for (const Case& each : cases) {
      SCOPED_TRACE(each.what);
      const Judgement judgement = found(each.ages);
      EXPECT_EQ(judgement.silent.has_value(), each.is_mode && !is_accepted);
      EXPECT_EQ(!judgement.mode.empty(), each.is_mode && is_accepted);
      EXPECT_EQ(share(each.of), each.share);
      together_->restart();
    }
  }

  const Strings four_{"/arm", "/laser", "/lidar", "/wheels"};
  const Ages stopped_{kAgo, kAgo, kAgo, kAgo, 0, 0};
};

TEST_F(NewModeTest, NobodyIsToBlameWhereFourThatDoNotHearEachOtherStopTogether) {
  const std::optional<Silent> silent = excuse({kAgo, kAgo, kAgo + kSecond / 50, kAgo, 0, 0});
  ASSERT_TRUE(silent);
  EXPECT_TRUE(silent->others_go_on);
  EXPECT_EQ(silent->components, four_);
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
  const Ages ages{kAgo, kAgo + kSecond / 50, kAgo, kAgo, kAgo + kSecond / 50, 0};
  EXPECT_TRUE(excuse(ages));
  beginAnew();
  abnormal_[kSlam] = kEnd - kAgo - kMillisecond;
  EXPECT_FALSE(excuse(ages)) << "the other three are too few";
  EXPECT_EQ(share(1), 2);
}

TEST_F(NewModeTest, FourThatStopAtOneTimeAreExcusedWithTheirVictims) {
  expect({{"three are faults", {kAgo, kAgo, kAgo, 0, 0, 0}, false, 0, 2},
          {"a victim is none of the four", {kAgo, kAgo, kAgo, 0, kAgo, 0}, false, 0, 2},
          {"but excused with them", {kAgo, kAgo, kAgo, kAgo, kAgo, 0}, true, kSlam, 0},
          {"also one that stops later", {kAgo, kAgo, kAgo, kAgo, kAgo / 2, 0}, true, kSlam, 0},
          {"not before, though it hears", {kAgo, kAgo, kAgo, kAgo, 2 * kAgo, 0}, true, kSlam, 2},
          {"nor who hears none of them", {kAgo, kAgo, kAgo, kAgo, 0, kAgo / 2}, true, kImu, 2},
          {"nor are they four then", {kAgo, kAgo, kAgo, 0, 0, kAgo / 2}, false, kImu, 2}},
         false);
  const Ages all{kAgo, kAgo, kAgo, kAgo, kAgo - kSecond, kAgo - 2 * kSecond};
  EXPECT_FALSE(excuse(all)) << "where nobody is heard since, all are silent";
}

TEST_F(NewModeTest, WhoMayBeSilentIsNoneOfTheFour) {
  moment_->may_be_silent[2] = true;
  EXPECT_FALSE(excuse(stopped_));
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

TEST_F(NewModeTest, WhoHearsAnotherOrMayDoSoIsNoneOfTheFour) {
  graph_->connect("/wheels", "/odom", "/arm");
  EXPECT_FALSE(excuse(stopped_)) << "the graph may grow";
  graph_ = std::make_shared<SourceGraph>();
  beginAnew();
  EXPECT_FALSE(excuse(stopped_)) << "without a graph, they may be victims";
}

TEST_F(NewModeTest, WhoComesBackLastIsExcusedForAMoment) {
  EXPECT_TRUE(excuse(stopped_));
  EXPECT_TRUE(excuse({kAgo + kSecond, 0, 0, 0, 0, 0}, kEnd + kSecond));
  EXPECT_EQ(share(0), 0);
  EXPECT_FALSE(excuse({kAgo + 4 * kSecond, 0, 0, 0, 0, 0}, kEnd + 4 * kSecond));
  EXPECT_EQ(share(0), 2);
  EXPECT_TRUE(excuse(stopped_));
  together_->restart();
  EXPECT_FALSE(excuse({kAgo + kSecond, 0, 0, 0, 0, 0}, kEnd + kSecond)) << "after a restart";
}

TEST_F(NewModeTest, WhatIsAcceptedIsNormal) {
  EXPECT_FALSE(isNormal(stopped_)) << "it is not yet";
  accept();
  EXPECT_TRUE(isNormal(stopped_));
  EXPECT_EQ(shares_, std::vector<double>(shares_.size(), 0));
  EXPECT_TRUE(isNormal({kAgo + kSecond, 0, 0, 0, 0, 0}, kEnd + kSecond)) << "it comes back last";
  EXPECT_EQ(share(0), 0);
}

TEST_F(NewModeTest, OfAnAcceptedModeWhoGoesOnAndWhoDiesIsJudged) {
  constexpr std::int64_t kBegan = 90 * kSecond;
  constexpr std::int64_t kGap = 100 * kMillisecond;
  const Ages faults_of_more{kAgo, kAgo, kAgo, kAgo, 0, kAgo};
  accept();
  expect({{"its victim", {kBegan, kBegan, kBegan, kBegan, 40 * kSecond, 0}, true, kSlam, 0},
          {"went on without it", {kBegan, kBegan, kBegan, kBegan, 5 * kSecond, 0}, true, kSlam, 2},
          {"another one dies", {kAgo, kAgo, kAgo, kAgo, 0, kAgo / 2}, true, kImu, 2},
          {"the first one missed", {30 * kGap, 29 * kGap, 28 * kGap, 27 * kGap, 0, 0}, true, 0, 0},
          {"two heard since", {10 * kGap, 9 * kGap, kGap / 10, kGap / 10, 0, 0}, false, 0, 2},
          {"a death", {kAgo, 0, 0, 0, 0, 0}, false, 0, 2},
          {"three are faults", {kAgo, kAgo, kAgo, 0, 0, 0}, false, 0, 2}},
         true);
  EXPECT_FALSE(isNormal({kAgo, kAgo, kAgo, 0, 0, kAgo}));
  together_->restart();
  EXPECT_TRUE(excuse(faults_of_more)) << "that of more is new";
}

TEST_F(NewModeTest, AnAcceptedModeDoesNotHideThatAllFellSilent) {
  accept();
  const Judgement judgement = found({kAgo, kAgo, kAgo, kAgo, kAgo, kAgo});
  ASSERT_TRUE(judgement.silent);
  EXPECT_FALSE(judgement.silent->others_go_on);
  EXPECT_EQ(judgement.silent->components.size(), kRobot.size());
  EXPECT_EQ(excused_, std::vector<Excused>(kRobot.size(), Excused::kAllSilent));
}

TEST_F(NewModeTest, AnAcceptedOneIsNeitherSuspiciousNorAShareOfALimit) {
  Limits limits = allLimits(*model_, kNone);
  Events events;
  for (EventId id = 0; id < kRobot.size(); ++id) {
    ofTrack(limits.tracks, *model_, kOverdue, id) = 2;
    const std::int64_t end = id < four_.size() ? 20 * kSecond : 40 * kSecond;
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
    asked->accept(is_accepted ? allOf({acceptedMode(four_)}) : Acceptances{});
    judge(std::move(asked), events, [&](const Verdict& verdict) {
      if (!unusual && (verdict.abnormal || verdict.suspicion || verdict.silent)) {
        unusual = verdict.window->start;
      }
      mode = verdict.mode;
    });
    EXPECT_EQ(unusual.has_value(), !is_accepted);
    EXPECT_LT(unusual.value_or(0), 23 * kSecond);
    EXPECT_EQ(largest > 1, !is_accepted);
    EXPECT_EQ(mode, is_accepted ? four_ : Strings{});
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

// 150 that all hear a root and others, and one that hears nobody.
class NewModeOfALargeRobotTest : public StoppedTest {
 protected:
  NewModeOfALargeRobotTest() : StoppedTest(numberedTypes(kRoot + 2)) {
    for (EventId id = 0; id < kRoot; ++id) {
      for (const EventId from : {kRoot, id / 2, (7 * id + 3) % kRoot}) {
        graph_->connect(types_[from].source, types_[from].scope, types_[id].source);
      }
    }
    Tuning tuning;
    tuning.without = {kPairs, kSlower, kFaster, kDeadlines};
    learn(
        [](std::int64_t start, unsigned /*seed*/) {
          Events events;
          for (EventId id = 0; id <= kRoot + 1; ++id) {
            events = together({events, timer(id, start, start + 20 * kSecond, kSecond / 5)});
          }
          return events;
        },
        *graph_, tuning);
  }
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
