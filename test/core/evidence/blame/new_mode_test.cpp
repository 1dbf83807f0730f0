#include "core/evidence/blame/new_mode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../recordings.h"
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
  Events events;
  for (EventId id = 0; id < kRobot.size(); ++id) {
    events = together({events, irregular(id, start, start + kEnd, 100 * kMillisecond, seed + id)});
  }
  return events;
}

std::unique_ptr<NewMode> newMode(const std::shared_ptr<const Model>& model,
                                 std::shared_ptr<const SourceGraph> graph) {
  return std::make_unique<NewMode>(
      model, std::make_shared<Upstream>(model->components(), std::move(graph)));
}

class NewModeTest : public testing::Test {
 protected:
  NewModeTest() { graph_->connect("/laser", "/scan", "/slam"); }

  /// Judges who stopped so long ago [ns], all of them beyond their limits.
  std::optional<Silent> excuse(const std::vector<std::int64_t>& ages, std::int64_t now = kEnd) {
    Scorer scorer(model_, kWindow);
    const Limits limits = close(scorer, ages, now);
    return new_mode_->excuse(shares_, limits, scorer, may_be_silent_);
  }
  /// Whether that is a mode which is accepted.
  bool isNormal(const std::vector<std::int64_t>& ages, std::int64_t now = kEnd) {
    Scorer scorer(model_, kWindow);
    const Limits limits = close(scorer, ages, now);
    return !new_mode_->excuseAccepted(shares_, limits, scorer, may_be_silent_).empty();
  }
  void accept(const Strings& together) {
    Acceptance mode;
    mode.kind = Kind::kNewMode;
    mode.together = together;
    Acceptances accepted;
    accepted.add(mode);
    new_mode_->accept(accepted);
  }
  /// @return limits of the model's tracks
  Limits close(Scorer& scorer, const std::vector<std::int64_t>& ages, std::int64_t now) {
    Events last;
    for (EventId id = 0; id < kRobot.size(); ++id) {
      last.push_back({now - ages[id], id});
    }
    for (const Event& event : together({last})) {
      scorer.add(event);
    }
    scorer.closeWindow(now);
    shares_.assign(model_->tracks().size(), 0);
    for (EventId id = 0; id < kRobot.size(); ++id) {
      share(id) = ages[id] > 0 ? 2 : 0;
    }
    return {std::vector<double>(model_->tracks().size(), 1), {}};
  }
  double& share(EventId id) { return shares_[indexOf(model_->tracks(), kOverdue, id, id)]; }

  std::vector<double> shares_;
  std::vector<bool> may_be_silent_ = std::vector<bool>(kRobot.size(), false);
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  std::shared_ptr<const Model> model_ = std::make_shared<Model>(
      watch(countsOf({robot(0, 100)}, kRobot), countsOf({robot(kStart, 200)}, kRobot)));
  std::unique_ptr<NewMode> new_mode_ = newMode(model_, graph_);
};

TEST_F(NewModeTest, NobodyIsToBlameWhereFourThatDoNotHearEachOtherStopTogether) {
  const std::optional<Silent> silent = excuse({kAgo, kAgo, kAgo + kSecond, kAgo, 0, 0});
  ASSERT_TRUE(silent);
  EXPECT_TRUE(silent->others_go_on);
  EXPECT_EQ(silent->components, (Strings{"/arm", "/laser", "/lidar", "/wheels"}));
  EXPECT_EQ(silent->since, kEnd - kAgo);
  EXPECT_EQ(shares_, std::vector<double>(shares_.size(), 0));
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
  new_mode_ = newMode(model_, std::make_shared<SourceGraph>());
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
  EXPECT_EQ(share(0), 2);
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
  for (const std::vector<std::int64_t>& faults : {std::vector<std::int64_t>{kAgo, 0, 0, 0, 0, 0},
                                                  {kAgo, kAgo, kAgo, 0, 0, 0},
                                                  {kAgo, kAgo, kAgo, 0, 0, kAgo},
                                                  {kAgo, kAgo, kAgo, kAgo, 0, kAgo}}) {
    EXPECT_FALSE(isNormal(faults));
    EXPECT_EQ(share(0), 2);
    new_mode_->restart();
  }
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, kAgo})) << "that of more is new";
}

TEST_F(NewModeTest, AfterARestartNothingIsExcused) {
  EXPECT_TRUE(excuse({kAgo, kAgo, kAgo, kAgo, 0, 0}));
  new_mode_->restart();
  EXPECT_FALSE(excuse({kAgo + kSecond, 0, 0, 0, 0, 0}, kEnd + kSecond));
}

/// What a judge says of a robot some of whom stop after 20 s.
class AcceptedModeTest : public NewModeTest {
 protected:
  struct Said {
    std::optional<std::int64_t> first;  ///< end of the first unusual window [ns]
    double largest = 0;                 ///< share that was told
    Strings mode;                       ///< of the last window
  };
  Said judge(const std::vector<EventId>& stopping, const Acceptances& accepted) {
    Limits limits{std::vector<double>(model_->tracks().size(), std::nan("")), {}};
    for (EventId id = 0; id < kRobot.size(); ++id) {
      limits.tracks[indexOf(model_->tracks(), kOverdue, id, id)] =
          model_->overdue(id, 2 * kSecond);
    }
    Said said;
    const auto judge = makeJudge(model_, limits, kWindow, graph_, nullptr,
                                 [&](const Window& /*window*/, const Shares& shares) {
                                   for (const double share : shares.tracks) {
                                     said.largest = std::max(said.largest, share);
                                   }
                                 });
    judge->accept(accepted);
    Events events;
    for (EventId id = 0; id < kRobot.size(); ++id) {
      const bool stops = std::count(stopping.begin(), stopping.end(), id) > 0;
      events = together(
          {events, timer(id, 0, stops ? 20 * kSecond : 40 * kSecond, 100 * kMillisecond)});
    }
    std::size_t next = 0;
    for (std::int64_t end = kWindow; end <= 40 * kSecond; end += kWindow) {
      for (; next < events.size() && events[next].stamp < end; ++next) {
        judge->add(events[next]);
      }
      Window window;
      window.start = end - kWindow;
      const Judgement judgement = judge->judge(window, end, NameSuspects::kIfUnusual);
      said.mode = judgement.mode;
      if ((judgement.abnormal || judgement.suspicious || judgement.silent) && !said.first) {
        said.first = end;
      }
    }
    return said;
  }
  static Acceptances withMode(const Strings& together) {
    Acceptance mode;
    mode.kind = Kind::kNewMode;
    mode.together = together;
    Acceptances accepted;
    accepted.add(mode);
    return accepted;
  }
};

TEST_F(AcceptedModeTest, IsNeitherSuspiciousNorAShareOfALimit) {
  const Said before = judge({0, 1, 2, 3}, {});
  ASSERT_TRUE(before.first);
  EXPECT_LT(*before.first, 23 * kSecond);
  EXPECT_GT(before.largest, 1);
  const Said after = judge({0, 1, 2, 3}, withMode({"/arm", "/laser", "/lidar", "/wheels"}));
  EXPECT_FALSE(after.first);
  EXPECT_TRUE(before.mode.empty());
  EXPECT_EQ(after.mode, (Strings{"/arm", "/laser", "/lidar", "/wheels"}));
  EXPECT_LE(after.largest, 1);
}

TEST_F(AcceptedModeTest, WhoDiesByHimselfIsFoundAsSoonAsBefore) {
  const Acceptances accepted = withMode({"/arm", "/laser", "/lidar", "/wheels"});
  for (const std::vector<EventId>& dead :
       {std::vector<EventId>{0}, {2}, {0, 2}, {0, 1, 2}, {kImu}}) {
    const Said before = judge(dead, {});
    ASSERT_TRUE(before.first);
    EXPECT_EQ(judge(dead, accepted).first, before.first);
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
  const Limits limits{std::vector<double>(model->tracks().size(), 1), {}};
  for (const double owed : {0.5, 2.0}) {
    std::vector<double> shares(model->tracks().size(), 0);
    for (EventId id = 1; id < types.size(); ++id) {
      shares[indexOf(model->tracks(), kOverdue, id, id)] = 2;
    }
    shares[indexOf(model->tracks(), kDeadlines, kServer, 0)] = owed;
    const std::optional<Silent> silent =
        newMode(model, graph)
            ->excuse(shares, limits, scorer, std::vector<bool>(types.size(), false));
    ASSERT_TRUE(silent);
    EXPECT_EQ(silent->has("/server"), owed < 1);
    EXPECT_EQ(shares[indexOf(model->tracks(), kOverdue, kServer, kServer)], owed < 1 ? 0 : 2);
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
    for (const Event& event : together({last})) {
      scorer.add(event);
    }
    scorer.closeWindow(kEnd);
    std::vector<double> shares(model_->tracks().size(), 0);
    for (EventId id = 1; id < kImuOfPlanned; ++id) {
      shares[indexOf(model_->tracks(), kOverdue, id, id)] = 2;
    }
    const Limits limits{std::vector<double>(model_->tracks().size(), 1), {}};
    const std::unique_ptr<NewMode> new_mode = newMode(model_, graph_);
    return new_mode->excuse(shares, limits, scorer, std::vector<bool>(model_->size(), false))
        .has_value();
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
    Events events = irregular(kImu, start, start + kEnd, 100 * kMillisecond, seed + kImu);
    for (std::int64_t session = start; session < start + kEnd; session += 20 * kSecond) {
      for (EventId id = 0; id < kImu; ++id) {
        events = together({events, irregular(id, session, session + 10 * kSecond,
                                             100 * kMillisecond, seed + id)});
      }
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
  std::vector<double> shares(model_->tracks().size(), 0);
  std::size_t beyond = 0;
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const Track& watched = model_->tracks()[track];
    if (channelName(watched) == "company" && watched.to < kSlam) {
      shares[track] = 2;
      ++beyond;
    }
  }
  ASSERT_GE(beyond, 4U);
  const Limits limits{std::vector<double>(shares.size(), 1), {}};
  const std::unique_ptr<NewMode> new_mode = newMode(model_, graph_);
  const auto found =
      new_mode->excuse(shares, limits, scorer, std::vector<bool>(model_->size(), false));
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
  tuning.without = {kPairs, kOwnGaps, kDeadlines};
  const auto model = std::make_shared<Model>(
      watch(countsOf({events}, types), countsOf({later(events)}, types), *graph, tuning));
  Scorer scorer(model, kWindow);
  for (const Event& event : events) {
    scorer.add(event);
  }
  scorer.add({40 * kSecond, kTypes + 1});
  scorer.closeWindow(40 * kSecond);
  std::vector<double> shares(model->tracks().size(), 0);
  for (EventId id = 0; id <= kTypes; ++id) {
    shares.at(indexOf(model->tracks(), kOverdue, id, id)) = 2;
  }
  const Limits limits{std::vector<double>(shares.size(), 1), {}};
  const std::unique_ptr<NewMode> new_mode = newMode(model, graph);
  const std::vector<bool> none(model->size(), false);
  const std::clock_t begin = std::clock();
  for (int window = 0; window < kWindows; ++window) {
    EXPECT_FALSE(new_mode->excuse(shares, limits, scorer, none));
  }
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  RecordProperty("milliseconds", std::to_string(1000 * seconds / kWindows));
  EXPECT_LT(seconds / kWindows, 0.01);
}

}  // namespace
}  // namespace self_awareness::core::evidence
