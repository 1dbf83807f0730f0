#include "core/evidence/channel/company.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "../judged.h"
#include "channel_case.h"
#include "core/evidence/watch/relations.h"
#include "self_awareness/core/evidence/limits/limits.h"
#include "self_awareness/core/stream/mode.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kFast = 50 * kMillisecond;
constexpr std::int64_t kSlow = 120 * kMillisecond;
constexpr std::int64_t kSession = 20 * kSecond;

/// A timer that runs in every second stretch of a length, from `first` on.
Events inSessions(EventId id, std::int64_t first, std::int64_t period, std::int64_t session) {
  Events events;
  for (std::int64_t number = 0; number < 5; ++number) {
    const std::int64_t start = first + 2 * number * session;
    const Events one = timer(id, start, start + session, period);
    events.insert(events.end(), one.begin(), one.end());
  }
  return events;
}

/// A and B run in the same sessions, and C does all the time.
Events modes(std::int64_t begin) {
  return later(together({inSessions(kA, 10 * kMillisecond, kFast, kSession),
                         inSessions(kB, 0, kSlow, kSession),
                         timer(kC, 0, 10 * kSession, 500 * kMillisecond)}),
               begin);
}

class InCompanyTest : public TrackTest {
 protected:
  bool watches(EventId to, EventId from) const {
    return isWatched(model_->tracks(), kCompany, to, from);
  }
};

class CompanyTest : public InCompanyTest {
 protected:
  void learn(const SourceGraph& graph = {}) {
    learn(countsOf({modes(kStart)}), countsOf({modes(2 * kStart)}), graph);
  }
  void learn(const Statistics& first, const Statistics& second, const SourceGraph& graph = {}) {
    TrackTest::learn(watch(first, second, graph), kCompany, kA, kB);
  }
};

TEST_F(CompanyTest, WhoPausesTogetherIsInCompanyUnlessItIsSentTheMessages) {
  learn();
  EXPECT_TRUE(watches(kA, kB));
  EXPECT_TRUE(watches(kB, kA));
  EXPECT_FALSE(watches(kA, kC)) << "it goes on while A pauses";
  EXPECT_FALSE(watches(kC, kA)) << "it does not pause";
  SourceGraph graph;
  graph.connect("/a", "/x", "/b");
  learn(graph);
  EXPECT_FALSE(watches(kA, kB)) << "B hears A, so it cannot tell that A has died";
  EXPECT_TRUE(watches(kB, kA));
}

TEST_F(CompanyTest, OtherPausesAreNoCompany) {
  const auto start = [](std::int64_t begin, std::int64_t session) {
    return countsOf({later(together({inSessions(kA, 0, kFast, kSession),
                                     inSessions(kB, 5 * kSecond, kSlow, session)}),
                           begin)});
  };
  learn(start(kStart, kSession * 3 / 4), start(2 * kStart, kSession / 2));
  EXPECT_FALSE(watches(kA, kB));
  EXPECT_FALSE(watches(kB, kA));
  learn(countsOf({modes(kStart)}), countsOf({modes(kStart + kSecond)}));
  EXPECT_FALSE(watches(kA, kB)) << "those of one start may be chance";
}

TEST_F(CompanyTest, SilenceCountsWhileTheOtherGoesOn) {
  learn();
  scorer_->add({0, kA});
  for (int k = 1; k <= 10; ++k) {
    scorer_->add({k * kSlow, kB});
  }
  EXPECT_EQ(evidenceAt(2 * kSecond), 10);
  EXPECT_EQ(reason().kind, Kind::kSilent);
  EXPECT_EQ(reason().after, "/b /y T");
  EXPECT_EQ(reason().unit, unit::kRequests);
  EXPECT_EQ(reason().value, 10);
  EXPECT_EQ(reason().words, "has not come with the last 10 /b /y T, which pauses when it does");
  EXPECT_EQ(evidenceAt(100 * kSecond), 10) << "a pause of both is none of one";
  scorer_->add({100 * kSecond, kA});
  EXPECT_EQ(evidenceAt(101 * kSecond), 0);
}

TEST_F(CompanyTest, ThatItComesAfterAllIsNewsOnce) {
  learn();
  scorer_->capAt(allLimits(*model_, 20));
  std::int64_t now = 0;
  scorer_->add({now, kA});
  const auto goOn = [&](int times) {
    double most = 0;
    for (int k = 0; k < times; ++k) {
      scorer_->add({now += kSlow, kB});
      most = std::max(most, evidenceAt(now));
    }
    scorer_->add({now += kWindow, kA});
    evidenceAt(now += kWindow);
    return most;
  };
  for (int k = 0; k < 30; ++k) {
    scorer_->add({now += kSlow, kB});
    evidenceAt(now);
  }
  scorer_->forget(kA);
  EXPECT_EQ(evidenceAt(now += kWindow), 0);
  EXPECT_EQ(scorer_->raisedBy(track_), 0) << "it has not come";
  EXPECT_EQ(goOn(30), 30);
  EXPECT_EQ(scorer_->raisedBy(track_), kUnlimited);
  for (int k = 0; k < 2 * kArming; ++k) {
    EXPECT_EQ(goOn(10), 0) << "pauses as in training";
  }
  EXPECT_EQ(goOn(30), 30);
}

TEST_F(CompanyTest, WhoWasNeverHeardMayBeStartingForAMinute) {
  learn();
  for (std::int64_t stamp = 0; stamp < 60 * kSecond; stamp += kSlow) {
    scorer_->add({stamp, kB});
  }
  EXPECT_EQ(evidenceAt(60 * kSecond - kWindow), 0);
  EXPECT_EQ(evidenceAt(60 * kSecond), 500);
}

TEST_F(CompanyTest, ARestartForgetsIt) {
  learn();
  scorer_->add({0, kA});
  scorer_->add({kSlow, kB});
  EXPECT_EQ(evidenceAt(kSecond), 1);
  scorer_->forget(kB);
  EXPECT_EQ(evidenceAt(kSecond), 0);
  scorer_->add({kSecond, kB});
  scorer_->restart();
  scorer_->add({20 * kSecond, kA});
  EXPECT_EQ(evidenceAt(30 * kSecond), 0);
}

TEST_F(CompanyTest, ItIsJudgedWhereItSaysMoreThanSilenceAfterALeastTime) {
  learn();
  const Expectation& expected = model_->expectation(track_);
  EXPECT_EQ(expected.limit(track_, 3, 7), 7);
  EXPECT_TRUE(std::isnan(expected.limit(track_, 1000, 2000))) << "as long as a pause";
  const double lateness = model_->tuning().least_lateness;  // however fast the other one is
  EXPECT_NEAR(model_->leastLimit(track_), lateness / toSeconds(kSlow), 1);
  track_ = indexOf(model_->tracks(), kCompany, kB, kA);
  EXPECT_NEAR(model_->leastLimit(track_), lateness / toSeconds(kFast), 2);
}

constexpr EventId kPlan = 0;
constexpr EventId kImu = 1;
constexpr EventId kState = 2;
constexpr EventId kDriving = 3;
constexpr EventId kDocked = 4;
constexpr EventId kNewMode = 5;
const std::vector<EventType> kRobot{
    {"/planner", "/plan", "T"},
    {"/imu", "/imu/data", "T"},
    {"/logic", "/state", "S"},
    {"/logic", "/state", typeOfMode("S", "DRIVING")},
    {"/logic", "/state", typeOfMode("S", "DOCKED")},
};

constexpr std::int64_t kDrive = 20 * kSecond;
constexpr std::int64_t kCharge = 100 * kSecond;
constexpr std::int64_t kCycle = kDrive + kCharge;
constexpr std::int64_t kPlanning = 100 * kMillisecond;
constexpr std::int64_t kEnd = 5 * kCycle;

/// A message that says a state, and what it says of the mode.
Events told(std::int64_t stamp, EventId mode, bool with_mode) {
  return with_mode ? Events{{stamp, mode}, {stamp, kState}} : Events{{stamp, kState}};
}

/// A robot that drives and charges in turn, and says so when it begins to. The planner plans while
/// it drives, until it dies.
Events driving(std::int64_t begin, bool with_mode = true, std::int64_t planner_dies = kEnd) {
  Events plans;
  Events states;
  for (std::int64_t start = 0; start < kEnd; start += kCycle) {
    const std::int64_t end = std::min(start + kDrive, planner_dies);
    plans = together({plans, timer(kPlan, start + 300 * kMillisecond, end, kPlanning)});
    states = together(
        {states, told(start, kDriving, with_mode), told(start + kDrive, kDocked, with_mode)});
  }
  return later(together({states, plans, timer(kImu, 7 * kMillisecond, kEnd, kPlanning)}), begin);
}

class ModeCompanyTest : public InCompanyTest {
 protected:
  void learn(const SourceGraph& graph = {}, const std::vector<EventType>& types = kRobot) {
    TrackTest::learn(
        watch(countsOf({driving(kStart)}, types), countsOf({driving(2 * kStart)}, types), graph),
        kCompany, kPlan, kDriving);
  }
};

TEST_F(ModeCompanyTest, WhoPausesInOtherModesIsInCompanyWithOne) {
  learn();
  EXPECT_TRUE(watches(kPlan, kDriving));
  EXPECT_FALSE(watches(kPlan, kDocked));
  EXPECT_FALSE(watches(kImu, kDriving)) << "it does not pause";
  EXPECT_FALSE(watches(kDriving, kPlan)) << "a mode cannot be silent";
  // It has the least limit of who comes every second.
  EXPECT_EQ(model_->leastLimit(track_), model_->tuning().least_requests);
  EXPECT_EQ(model_->expectation(track_).timeUntil(track_, 4), 4.0 * kSecond);
}

TEST_F(ModeCompanyTest, WhoHearsItOrTellsItIsInCompanyAsWell) {
  SourceGraph graph;
  graph.connect("/logic", "/state", "/planner");
  graph.connect("/planner", "/plan", "/logic");
  learn(graph);
  EXPECT_TRUE(watches(kPlan, kDriving)) << "the mode lasts, whoever has died";
  std::vector<EventType> types = kRobot;
  types[kPlan].source = types[kState].source;
  learn({}, types);
  EXPECT_TRUE(watches(kPlan, kDriving)) << "of one node";
}

TEST_F(ModeCompanyTest, NobodyElseSeesAMode) {
  learn();
  const Statistics with = countsOf({driving(kStart)}, kRobot);
  const Statistics without = countsOf({driving(kStart, false)}, kRobot);
  const Model plain(watch(without, countsOf({driving(2 * kStart, false)}, kRobot)));
  std::vector<Track> others = model_->tracks();
  others.erase(std::remove_if(others.begin(), others.end(),
                              [](const Track& track) { return track.from == kDriving; }),
               others.end());
  expectSameTracks(others, plain.tracks());
  EXPECT_EQ(model_->learned().delaysToAny()[kPlan], plain.learned().delaysToAny()[kPlan]);
  const SourceGraph graph;
  const Tuning tuning;
  EXPECT_EQ(Relations(with, graph, tuning).lookedAt(), 6) << "of the three that come often";
  EXPECT_EQ(with.rateWindows(), without.rateWindows());
}

TEST_F(ModeCompanyTest, EvidenceIsTheTimeThatTheModeHasLasted) {
  learn();
  scorer_->enter({0, kDriving});
  scorer_->add({kSecond, kPlan});
  EXPECT_EQ(evidenceAt(kSecond), 0);
  EXPECT_EQ(evidenceAt(6 * kSecond), 5);
  EXPECT_EQ(reason().kind, Kind::kSilent);
  EXPECT_EQ(reason().after, "/logic /state S[mode: DRIVING]");
  EXPECT_EQ(reason().unit, unit::kSeconds);
  EXPECT_EQ(reason().value, 5);
  EXPECT_EQ(reason().words,
            "has not come for 5 s of the mode DRIVING (/state), in which it does not pause");
  scorer_->enter({7 * kSecond, kDocked});
  EXPECT_EQ(evidenceAt(100 * kSecond), 6) << "the other mode says nothing";
  scorer_->enter({200 * kSecond, kDriving});
  EXPECT_EQ(evidenceAt(202 * kSecond), 8);
  scorer_->add({202 * kSecond, kPlan});
  EXPECT_EQ(evidenceAt(203 * kSecond), 1);
  scorer_->forget(kDriving);
  EXPECT_EQ(evidenceAt(204 * kSecond), 0) << "what is forgotten begins anew";
  EXPECT_EQ(evidenceAt(205 * kSecond), 1);
}

TEST_F(ModeCompanyTest, LimitsKnowTheModeThatLastsWhenTheClockIsSet) {
  learn();
  LimitFinder finder(model_, {kWindow, 5 * kSecond});
  finder.startRecording(model_);
  finder.add({500 * kSecond, kDriving});
  finder.add({501 * kSecond, kPlan});
  finder.add({10 * kSecond, kPlan});
  addAll(finder, timer(kImu, 10 * kSecond, 30 * kSecond, kPlanning));
  finder.add({30 * kSecond, kPlan});  // what it says of a silence that never ends is not known
  finder.add({31 * kSecond, kImu});
  finder.finish();
  EXPECT_NEAR(finder.findings().back().parts.back().evidence[track_], 20, 0.2);
}

/// What a model learns of starts of this robot, and what it says then.
class ModeLearnedTest : public testing::Test {
 protected:
  static core::Model learned(bool with_mode) {
    return learnedFrom(kRobot, {driving(kStart, with_mode), driving(2 * kStart, with_mode),
                                driving(3 * kStart, with_mode), driving(4 * kStart, with_mode)});
  }
  /// A judge that hears of one mode more, kNewMode.
  static std::unique_ptr<core::Judge> judgeOf(const core::Model& model) {
    const auto heard = std::make_shared<Vocabulary>(model.vocabulary());
    heard->intern({"/logic", "/state", typeOfMode("S", "LOST")});
    return model.makeJudge(heard);
  }
};

// A planner that dies while the robot drives is looked for as long as a charge lasts, unless the
// mode says that it drives.
TEST_F(ModeLearnedTest, ADeathWhileDrivingIsFoundSoon) {
  const std::int64_t dies = 9 * kStart + 2 * kCycle + 5 * kSecond;
  const auto found = alarmIn(judgeOf(learned(true)), driving(9 * kStart, true, dies - 9 * kStart));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->suspects.at(0).component, "/planner");
  EXPECT_LT(found->time - dies, 10 * kSecond);
  EXPECT_GT(found->time - dies, 2 * kSecond);
  const auto without =
      alarmIn(judgeOf(learned(false)), driving(9 * kStart, false, dies - 9 * kStart));
  EXPECT_TRUE(!without || without->time - dies > kCharge);
}

TEST_F(ModeLearnedTest, WhoMissedAMessageOfTheModeDoesNotKnowIt) {
  const core::Model model = learned(true);
  const std::int64_t dead = 9 * kStart + kCycle + 2 * kSecond;
  const auto dies = [&](const Ids& missed) {
    bool alarm = false;
    Detector detector(model.makeJudge(), model.window, {},
                      [&](const Verdict& verdict) { alarm = alarm || verdict.alarm; });
    addAll(detector,
           without(driving(9 * kStart), [&](const Event& event) { return event.stamp >= dead; }));
    detector.onMissed(missed, dead);
    addAll(detector, timer(kImu, dead, 9 * kStart + kCycle + kDrive, kPlanning));
    detector.finish();
    return alarm;
  };
  EXPECT_TRUE(dies({kState}));
  EXPECT_FALSE(dies({kState, kDriving, kDocked})) << "it may be another one by now";
}

TEST_F(ModeLearnedTest, AModeThatTrainingNeverSawIsNeitherAStrangerNorAReason) {
  const core::Model model = learned(true);
  EXPECT_FALSE(judgeOf(model)->add({9 * kStart, kNewMode})) << "no message of its own";
  // In the third drive something else is done for 15 s, and nothing is planned.
  const std::int64_t begin = 9 * kStart + 2 * kCycle + kSecond;
  const std::int64_t end = begin + 15 * kSecond;
  const Events silent = without(driving(9 * kStart), [&](const Event& event) {
    return event.id == kPlan && event.stamp >= begin && event.stamp < end;
  });
  EXPECT_FALSE(alarmIn(judgeOf(model), together({silent, {{begin, kNewMode}, {end, kDriving}}})));
  EXPECT_TRUE(alarmIn(judgeOf(model), silent)) << "the same without the mode that is told";
}

}  // namespace
}  // namespace self_awareness::core::evidence
