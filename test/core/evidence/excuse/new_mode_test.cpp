#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../../verdict/accepted.h"
#include "../judged.h"
#include "../tracks.h"
#include "core/evidence/excuse/stopped_together.h"
#include "self_awareness/core/evidence/judge.h"

namespace self_awareness::core::evidence {
namespace {

using Strings = std::vector<std::string>;

const std::vector<EventType> kRobot{{"/wheels", "/odom", "T"}, {"/laser", "/scan", "T"},
                                    {"/arm", "/joints", "T"},  {"/lidar", "/cloud", "T"},
                                    {"/slam", "/pose", "T"},   {"/imu", "/imu/data", "T"}};
constexpr EventId kSlam = 4;
constexpr EventId kImu = 5;
constexpr std::int64_t kEnd = 100 * kSecond;
constexpr std::int64_t kAgo = 30 * kSecond;

Events robot(std::int64_t start, unsigned seed) {
  return atRandom(kRobot.size(), start, kEnd, 100 * kMillisecond, seed);
}

std::unique_ptr<StoppedTogether> excuseOf(const std::shared_ptr<const Model>& model,
                                          const std::shared_ptr<const SourceGraph>& graph) {
  return std::make_unique<StoppedTogether>(
      model, std::make_shared<Upstream>(model->components(), graph), graph);
}

/// What is excused where every limit is 1; its shares become 0.
StoppedTogether::Found excuseBy(StoppedTogether& together,
                                const std::shared_ptr<const Model>& model,
                                std::vector<double>& shares, const Scorer& scorer,
                                const std::vector<bool>& may_be_silent) {
  std::vector<Excess> excesses = excessesOf(model, shares, scorer);
  StoppedTogether::Found found =
      together.excuse(excesses, allLimits(*model, 1), scorer, {}, may_be_silent);
  for (const Excess& excess : excesses) {
    shares[excess.track] = excess.excuse == Excuse::kNone ? shares[excess.track] : 0;
  }
  return found;
}

/// The same where nobody may be silent.
std::optional<Silent> excuseAny(const std::shared_ptr<const Model>& model,
                                const std::shared_ptr<const SourceGraph>& graph,
                                std::vector<double>& shares, const Scorer& scorer) {
  return excuseBy(*excuseOf(model, graph), model, shares, scorer,
                  std::vector<bool>(model->size(), false))
      .silent;
}

class NewModeTest : public testing::Test {
 protected:
  NewModeTest() { graph_->connect("/laser", "/scan", "/slam"); }

  /// Judges who stopped so long ago [ns], all of them beyond their limits.
  StoppedTogether::Found found(const std::vector<std::int64_t>& ages, std::int64_t now) {
    const Scorer scorer = heardLast(model_, ages, now);
    shares_ = allTracks(*model_, 0);
    for (EventId id = 0; id < kRobot.size(); ++id) {
      share(id) = ages[id] > 0 ? 2 : 0;
    }
    return excuseBy(*new_mode_, model_, shares_, scorer, may_be_silent_);
  }
  std::optional<Silent> excuse(const std::vector<std::int64_t>& ages, std::int64_t now = kEnd) {
    return found(ages, now).silent;
  }
  /// Whether that is a mode which is accepted.
  bool isNormal(const std::vector<std::int64_t>& ages, std::int64_t now = kEnd) {
    return !found(ages, now).mode.empty();
  }
  void accept(const Strings& together) { new_mode_->accept(allOf({acceptedMode(together)})); }
  double& share(EventId id) { return ofTrack(shares_, *model_, kOverdue, id); }

  std::vector<double> shares_;
  std::vector<bool> may_be_silent_ = std::vector<bool>(kRobot.size(), false);
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  std::shared_ptr<const Model> model_ = std::make_shared<Model>(
      watch(countsOf({robot(0, 100)}, kRobot), countsOf({robot(kStart, 200)}, kRobot)));
  std::unique_ptr<StoppedTogether> new_mode_ = excuseOf(model_, graph_);
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

TEST_F(NewModeTest, ThreeAreFaults) {
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, 0, 0, 0}));
  EXPECT_EQ(share(0), 2);
}

TEST_F(NewModeTest, AVictimIsNoneOfTheFour) {
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, 0, kAgo, 0}));
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, kAgo, 0}));
  EXPECT_EQ(share(kSlam), 0) << "but excused with them";
}

TEST_F(NewModeTest, WhoMayBeSilentIsNoneOfTheFour) {
  may_be_silent_[2] = true;
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
  EXPECT_EQ(share(0), 2);
  const std::optional<Silent> silent = excuse({kAgo, kAgo, kAgo, kAgo, 0, kAgo});
  ASSERT_TRUE(silent);
  EXPECT_EQ(silent->components, (Strings{"/imu", "/laser", "/lidar", "/wheels"}));
}

TEST_F(NewModeTest, WhoFellSilentBeforeIsNotExcusedThoughItHearsThem) {
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 2 * kAgo, 0}));
  EXPECT_EQ(share(kSlam), 2);
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
  new_mode_->restart();
  graph_->connect("/wheels", "/odom", "/arm");
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
}

TEST_F(NewModeTest, AVictimThatStopsLaterIsExcused) {
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, kAgo / 2, 0}));
  EXPECT_EQ(share(kSlam), 0);
}

TEST_F(NewModeTest, WhoStopsAtAnotherTimeIsNotExcused) {
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, kAgo / 2}));
  EXPECT_EQ(share(kImu), 2);
  new_mode_->restart();
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, 0, 0, kAgo / 2}));
}

TEST_F(NewModeTest, WhereNobodyIsHeardSinceAllAreSilent) {
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, kAgo, kAgo - kSecond, kAgo - 2 * kSecond}));
  EXPECT_EQ(share(0), 2);
}

TEST_F(NewModeTest, WithoutAGraphTheyMayBeVictims) {
  new_mode_ = excuseOf(model_, std::make_shared<SourceGraph>());
  EXPECT_FALSE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
}

TEST_F(NewModeTest, WhoComesBackLastIsExcusedForAMoment) {
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
  EXPECT_TRUE(excuse({kAgo + kSecond, 0, 0, 0, 0, 0}, kEnd + kSecond));
  EXPECT_EQ(share(0), 0);
  EXPECT_FALSE(excuse({kAgo + 4 * kSecond, 0, 0, 0, 0, 0}, kEnd + 4 * kSecond));
  EXPECT_EQ(share(0), 2);
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

TEST_F(NewModeTest, WhenAnAcceptedModeBeginsTheFirstOneMissedIsNotDead) {
  constexpr std::int64_t kGap = 100 * kMillisecond;
  accept({"/arm", "/laser", "/lidar", "/wheels"});
  EXPECT_TRUE(isNormal({30 * kGap, 29 * kGap, 28 * kGap, 27 * kGap, 0, 0}));
  new_mode_->restart();
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
    new_mode_->restart();
  }
  EXPECT_FALSE(isNormal({kAgo, kAgo, kAgo, 0, 0, kAgo}));
  new_mode_->restart();
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, kAgo})) << "that of more is new";
}

TEST_F(NewModeTest, AfterARestartNothingIsExcused) {
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
  new_mode_->restart();
  EXPECT_FALSE(excuse({kAgo + kSecond, 0, 0, 0, 0, 0}, kEnd + kSecond));
}

TEST_F(NewModeTest, AnAcceptedOneIsNeitherSuspiciousNorAShareOfALimit) {
  const Strings stopping{"/arm", "/laser", "/lidar", "/wheels"};
  Limits limits = allLimits(*model_, kNone);
  Events events;
  for (EventId id = 0; id < kRobot.size(); ++id) {
    ofTrack(limits.tracks, *model_, kOverdue, id) = model_->overdue(id, 2 * kSecond);
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

// A client that asks a server, and four more that do not hear each other.
TEST(NewModeOfServers, WhoOwesAnAnswerIsNotInANewMode) {
  const std::vector<EventType> types{{"/client", "/request", "T"}, {"/server", "/answer", "T"},
                                     {"/a", "/a/out", "T"},        {"/b", "/b/out", "T"},
                                     {"/c", "/c/out", "T"},        {"/d", "/d/out", "T"}};
  constexpr EventId kServer = 1;
  const auto robot = [&](std::int64_t start, unsigned seed) {
    const Events asked = irregular(0, start, start + 4 * kEnd, kSecond, seed);
    Events events = together({asked, answers(kServer, asked, 20 * kMillisecond)});
    for (EventId id = 2; id < types.size(); ++id) {
      events = together({events, irregular(id, start, start + 4 * kEnd, kSecond, seed + id)});
    }
    return events;
  };
  const auto graph = std::make_shared<SourceGraph>();
  graph->connect("/client", "/request", "/server");
  graph->connect("/server", "/answer", "/client");
  const auto model = std::make_shared<Model>(
      watch(countsOf({robot(0, 100)}, types), countsOf({robot(kStart, 200)}, types), *graph));
  ASSERT_TRUE(isWatched(model->tracks(), kDeadlines, kServer, 0));
  Scorer scorer(model, kWindow);
  for (EventId id = 0; id < types.size(); ++id) {
    scorer.add({id == 0 ? kEnd : kEnd - kAgo, id});
  }
  scorer.closeWindow(kEnd);
  for (const double owed : {0.5, 2.0}) {
    std::vector<double> shares = allTracks(*model, 0);
    for (EventId id = 1; id < types.size(); ++id) {
      ofTrack(shares, *model, kOverdue, id) = 2;
    }
    ofTrack(shares, *model, kDeadlines, kServer, 0) = owed;
    const std::optional<Silent> silent = excuseAny(model, graph, shares, scorer);
    ASSERT_TRUE(silent);
    EXPECT_EQ(silent->has("/server"), owed < 1);
    EXPECT_EQ(ofTrack(shares, *model, kOverdue, kServer), owed < 1 ? 0 : 2);
  }
}

// A planner that is heard every 30 s, too seldom to be judged, and controllers that need it.
class RootWithoutTrackTest : public testing::Test {
 protected:
  RootWithoutTrackTest() {
    for (EventId id = 1; id < kImuOfPlanned; ++id) {
      graph_->connect("/planner", "/plan", types()[id].source);
    }
  }
  static std::vector<EventType> types() {
    std::vector<EventType> types{{"/planner", "/plan", "T"}};
    for (EventId id = 1; id < kImuOfPlanned; ++id) {
      types.push_back({"/c" + std::to_string(id), "/command" + std::to_string(id), "T"});
    }
    types.push_back({"/imu", "/imu/data", "T"});
    return types;
  }
  static Events robot(std::int64_t start, unsigned seed) {
    Events events = timer(0, start, start + kEnd, 30 * kSecond);
    for (EventId id = 1; id <= kImuOfPlanned; ++id) {
      events =
          together({events, irregular(id, start, start + kEnd, 100 * kMillisecond, seed + id)});
    }
    return events;
  }
  /// Whether controllers that stopped kAgo are excused.
  /// @param planner when that was heard last [ns]
  bool isExcused(std::int64_t planner) {
    Scorer scorer(model_, kWindow);
    Events last{{planner, 0}, {kEnd, kImuOfPlanned}};
    for (EventId id = 1; id < kImuOfPlanned; ++id) {
      last.push_back({kEnd - kAgo, id});
    }
    addAll(scorer, together({last}));
    scorer.closeWindow(kEnd);
    std::vector<double> shares = allTracks(*model_, 0);
    for (EventId id = 1; id < kImuOfPlanned; ++id) {
      ofTrack(shares, *model_, kOverdue, id) = 2;
    }
    return excuseAny(model_, graph_, shares, scorer).has_value();
  }

  static constexpr EventId kImuOfPlanned = 5;
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  std::shared_ptr<const Model> model_ = std::make_shared<Model>(
      watch(countsOf({robot(0, 100)}, types()), countsOf({robot(kStart, 200)}, types())));
};

TEST_F(RootWithoutTrackTest, WhoWasNotHeardSinceMayHaveDied) {
  ASSERT_FALSE(isWatched(model_->tracks(), kOverdue, 0, 0));
  EXPECT_FALSE(isExcused(kEnd - kAgo - 10 * kMillisecond));
  EXPECT_FALSE(isExcused(kEnd - kAgo - 30 * kSecond)) << "for as long as it usually waits";
}

TEST_F(RootWithoutTrackTest, WhoWasHeardSinceIsAlive) {
  EXPECT_TRUE(isExcused(kEnd - kAgo + kMillisecond));
}

TEST_F(RootWithoutTrackTest, WhoWasSilentForLongBeforeIsNotMissed) {
  EXPECT_TRUE(isExcused(kEnd - kAgo - 33 * kSecond));
}

// Five that run in sessions only, and an IMU that always does.
class CompanyOfOthersTest : public testing::Test {
 protected:
  CompanyOfOthersTest() { graph_->connect("/laser", "/scan", "/slam"); }

  static Events robot(std::int64_t start, unsigned seed) {
    constexpr std::int64_t kGap = 100 * kMillisecond;
    Events events = irregular(kImu, start, start + kEnd, kGap, seed + kImu);
    for (std::int64_t session = start; session < start + kEnd; session += 20 * kSecond) {
      events = together({events, atRandom(kImu, session, 10 * kSecond, kGap, seed)});
    }
    return events;
  }

  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  std::shared_ptr<const Model> model_ = std::make_shared<Model>(
      watch(countsOf({robot(0, 100)}, kRobot), countsOf({robot(kStart, 200)}, kRobot)));
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
  std::vector<double> shares = allTracks(*model_, 0);
  std::size_t beyond = 0;
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const Track& watched = model_->tracks()[track];
    if (channelName(watched) == kCompany && watched.to < kSlam) {
      shares[track] = 2;
      ++beyond;
    }
  }
  ASSERT_GE(beyond, 4U);
  const std::optional<Silent> found = excuseAny(model_, graph_, shares, scorer);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->components, (Strings{"/arm", "/laser", "/lidar", "/wheels"}));
  EXPECT_EQ(shares, std::vector<double>(shares.size(), 0));
}

TEST(NewModeOfALargeRobot, TakesLittleTimeWhileAllWaitForOneThatDied) {
  constexpr EventId kComponents = 60;
  constexpr EventId kTypes = 150;
  constexpr int kWindows = 20;
  std::vector<EventType> types;
  auto graph = std::make_shared<SourceGraph>();
  const auto name = [](EventId component) { return "/c" + std::to_string(component); };
  Events events;
  for (EventId id = 0; id < kTypes; ++id) {
    const EventId component = id % kComponents;
    types.push_back({name(component), "/t" + std::to_string(id), "T"});
    graph->connect(name(component / 2), types[component / 2].scope, name(component));
    graph->connect(name(component), types.back().scope, name((7 * component + id) % kComponents));
    graph->connect("/root", "/root/out", name(component));
    events = together({events, timer(id, 0, 20 * kSecond, 200 * kMillisecond)});
  }
  types.push_back({"/root", "/root/out", "T"});
  types.push_back({"/alive", "/alive/out", "T"});
  events = together({events, timer(kTypes, 0, 20 * kSecond, 200 * kMillisecond),
                     timer(kTypes + 1, 0, 20 * kSecond, 200 * kMillisecond)});
  Tuning tuning;
  tuning.without = {kPairs, kSlower, kFaster, kDeadlines};
  const auto model = std::make_shared<Model>(
      watch(countsOf({events}, types), countsOf({later(events)}, types), *graph, tuning));
  Scorer scorer(model, kWindow);
  addAll(scorer, events);
  scorer.add({40 * kSecond, kTypes + 1});
  scorer.closeWindow(40 * kSecond);
  std::vector<double> shares = allTracks(*model, 0);
  for (EventId id = 0; id <= kTypes; ++id) {
    ofTrack(shares, *model, kOverdue, id) = 2;
  }
  const std::unique_ptr<StoppedTogether> new_mode = excuseOf(model, graph);
  const std::vector<bool> none(model->size(), false);
  const std::clock_t begin = std::clock();
  for (int window = 0; window < kWindows; ++window) {
    EXPECT_FALSE(excuseBy(*new_mode, model, shares, scorer, none).silent);
  }
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  RecordProperty("milliseconds", std::to_string(1000 * seconds / kWindows));
  EXPECT_LT(seconds / kWindows, 0.01);
}

}  // namespace
}  // namespace self_awareness::core::evidence
