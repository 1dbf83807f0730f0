#include "core/evidence/presence/never_heard.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../judged.h"
#include "../tracks.h"
#include "self_awareness/core/evidence/judge.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kSettle = 5 * kSecond;
constexpr std::int64_t kPeriod = 200 * kMillisecond;

// A robot of which A and B start at once, and C so much later; without it where that is none.
Events start(std::optional<std::int64_t> c_starts, unsigned seed,
             std::int64_t length = 60 * kSecond) {
  return together({irregular(kA, 0, length, kPeriod, seed),
                   irregular(kB, 50 * kMillisecond, length, kPeriod, seed + 1),
                   c_starts ? irregular(kC, *c_starts, length, kPeriod, seed + 2) : Events{}});
}

class NeverHeardTest : public testing::Test {
 protected:
  NeverHeardTest() { train({start(0, 1)}, {start(0, 7)}); }
  void train(const std::vector<Events>& first, const std::vector<Events>& second) {
    model_ = std::make_shared<Model>(watch(countsOf(first), countsOf(second)));
  }
  // It has heard these at its start.
  NeverHeard neverHeardBut(const Ids& ids, const Limits& limits = {}) const {
    NeverHeard never_heard(*model_, limits,
                           std::make_shared<Upstream>(model_->components(), graph_));
    for (const EventId id : ids) {
      never_heard.add({0, id});
    }
    return never_heard;
  }
  // The share after so much time in which only A was heard.
  static double shareAt(NeverHeard& never_heard, std::int64_t now) {
    never_heard.closeWindow(now, kSettle);
    return never_heard.share();
  }
  static Ids named(const NeverHeard& never_heard) { return idsOf(never_heard.suspects()); }

  // What the judge says once B has been silent for 30 s, and C was never heard.
  Judgement afterSilenceOfB() const {
    Limits limits = allLimits(*model_, kNone);
    ofTrack(limits.tracks, *model_, kOverdue, kB) = 5;
    const std::unique_ptr<core::Judge> judge = makeJudge(model_, limits, kWindow, graph_);
    addAll(*judge, start(std::nullopt, 3, 10 * kSecond));
    judge->add({40 * kSecond, kA});
    return judge->judge({40 * kSecond, {}}, 40 * kSecond, NameSuspects::kIfUnusual);
  }

  std::shared_ptr<const Model> model_;
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
};

TEST_F(NeverHeardTest, WhatComesLateAsAlwaysIsNormalAndWhatDoesNotComeIsNot) {
  train({start(14400 * kMillisecond, 1)}, {start(14600 * kMillisecond, 7)});
  NeverHeard never_heard = neverHeardBut({kA, kB});
  EXPECT_EQ(shareAt(never_heard, 29 * kSecond), 0);  // due after 2 * 14.6 s
  const double due = shareAt(never_heard, 29300 * kMillisecond);
  EXPECT_GT(due, 0);
  EXPECT_LT(due, 1);
  ASSERT_EQ(never_heard.suspects().size(), 1U);
  const Suspect suspect = never_heard.suspects().front();
  EXPECT_EQ(suspect.id, kC);
  EXPECT_EQ(suspect.reason.words, "not heard since the start, usually within 14.4 to 14.6 s");
  EXPECT_NEAR(suspect.reason.value, 29.3, 1e-9);
  EXPECT_EQ(suspect.component, "/c");
  EXPECT_FALSE(suspect.abnormal);
  EXPECT_LT(shareAt(never_heard, 116 * kSecond), 1);  // four times as late
  EXPECT_GT(shareAt(never_heard, 117 * kSecond), 1);
  EXPECT_TRUE(never_heard.suspects().front().abnormal);
  never_heard.add({118 * kSecond, kC});
  EXPECT_EQ(shareAt(never_heard, 119 * kSecond), 0);
  EXPECT_TRUE(never_heard.suspects().empty());
}

TEST_F(NeverHeardTest, WhatComesAtOnceHasTimeUntilItIsDue) {
  NeverHeard never_heard = neverHeardBut({kA});
  EXPECT_EQ(shareAt(never_heard, 5 * kSecond), 0);
  EXPECT_GT(shareAt(never_heard, 6 * kSecond), 0);
  EXPECT_EQ(named(never_heard), (Ids{kB, kC}));
  EXPECT_LT(shareAt(never_heard, 64 * kSecond), 1);  // at least 60 s after that
  EXPECT_GT(shareAt(never_heard, 66 * kSecond), 1);
  EXPECT_GT(shareAt(never_heard, 125 * kSecond), 1);
  EXPECT_EQ(shareAt(never_heard, 126 * kSecond), 1) << "for a minute, and suspicious from then on";
  EXPECT_FALSE(never_heard.suspects().front().abnormal);
  NeverHeard settles = neverHeardBut({kA});
  for (const std::int64_t over : {0, 1}) {
    settles.closeWindow(30 * kSecond + over, 30 * kSecond);
    EXPECT_EQ(settles.share() > 0, over == 1) << "a long settling time is waited for";
  }
}

TEST_F(NeverHeardTest, ATopicOfANodeThatSaysOtherThingsIsASuspicionOnly) {
  const auto both = [](std::int64_t from, unsigned seed) {
    return countsOf({start(from, seed)},
                    {{"/a", "/x", "T"}, {"/b", "/y", "T"}, {"/a", "/z", "T"}});
  };
  model_ = std::make_shared<Model>(watch(both(0, 1), both(0, 7)));
  NeverHeard never_heard = neverHeardBut({kA});
  EXPECT_GT(shareAt(never_heard, 66 * kSecond), 1);
  EXPECT_EQ(named(never_heard), (Ids{kB, kC}));
  EXPECT_TRUE(never_heard.suspects()[0].abnormal);
  EXPECT_FALSE(never_heard.suspects()[1].abnormal) << "/a says another thing";
  never_heard.add({67 * kSecond, kB});
  EXPECT_EQ(shareAt(never_heard, 68 * kSecond), 1);
}

TEST_F(NeverHeardTest, WhatWasLatchedInThreeRecordingsIsExpectedAndRaisesNoAlarm) {
  const auto withMap = [](unsigned seed, bool has_map) {
    Events events = start(std::nullopt, seed);
    if (has_map) {
      events.insert(events.begin() + 3, {events[3].stamp, kC});
    }
    return events;
  };
  const auto learn = [&](bool has_third, const std::string& node = "/map_server") {
    const std::vector<EventType> types{
        {"/a", "/x", "T"}, {"/b", "/y", "T"}, {node, "/map", "T[latched]"}};
    model_ = std::make_shared<Model>(watch(countsOf({withMap(1, true), withMap(3, true)}, types),
                                           countsOf({withMap(7, has_third)}, types)));
  };
  learn(false);
  NeverHeard not_expected = neverHeardBut({kA, kB});
  EXPECT_EQ(shareAt(not_expected, 600 * kSecond), 0) << "one recording lacks it";
  learn(true);
  NeverHeard never_heard = neverHeardBut({kA, kB});
  EXPECT_EQ(shareAt(never_heard, 59 * kSecond), 0);
  EXPECT_GT(shareAt(never_heard, 61 * kSecond), 0);
  EXPECT_EQ(named(never_heard), Ids{kC});
  EXPECT_EQ(shareAt(never_heard, 600 * kSecond), 1) << "no alarm";
  never_heard.restart();
  never_heard.add({600 * kSecond, kA});
  never_heard.add({600 * kSecond, kB});
  EXPECT_GT(shareAt(never_heard, 662 * kSecond), 0) << "it is still not there";
  never_heard.add({663 * kSecond, kC});
  EXPECT_EQ(shareAt(never_heard, 664 * kSecond), 0);
  never_heard.restart();  // the clock was set, and nobody sends it again
  never_heard.add({700 * kSecond, kA});
  never_heard.add({700 * kSecond, kB});
  EXPECT_EQ(shareAt(never_heard, 900 * kSecond), 0);
  learn(true, "/b");
  NeverHeard b_holds_it_ready = neverHeardBut({kA, kC});
  EXPECT_GT(shareAt(b_holds_it_ready, 66 * kSecond), 1) << "but sends nothing else";
}

TEST_F(NeverHeardTest, WhatCameInSomeRecordingsOnlyOrHasTooFewGapsIsNotExpected) {
  const Events rare = timer(kC, 0, 15 * kSecond, kSecond);  // 14 gaps in each half
  for (const bool few_gaps : {false, true}) {
    if (few_gaps) {
      train({together({start(std::nullopt, 1), rare})},
            {together({start(std::nullopt, 7), rare})});
    } else {
      train({start(0, 1), start(std::nullopt, 4)}, {start(0, 7)});
    }
    NeverHeard never_heard = neverHeardBut({kA});
    shareAt(never_heard, 600 * kSecond);
    EXPECT_EQ(named(never_heard), Ids{kB}) << few_gaps;
  }
}

TEST_F(NeverHeardTest, WhatIsSlowHasTwiceItsLongestGap) {
  const Events slow = timer(kC, 0, 1200 * kSecond, 30 * kSecond);
  train({together({start(std::nullopt, 1, 1200 * kSecond), slow})},
        {together({start(std::nullopt, 7, 1200 * kSecond), slow})});
  NeverHeard never_heard = neverHeardBut({kA, kB});
  EXPECT_EQ(shareAt(never_heard, 60 * kSecond), 0);
  EXPECT_GT(shareAt(never_heard, 61 * kSecond), 0);
}

TEST_F(NeverHeardTest, WhoMayBeSilentIsNotDueBefore) {
  Limits limits = allLimits(*model_, kNone);
  ofTrack(limits.tracks, *model_, kOverdue, kC) = 100;
  NeverHeard never_heard = neverHeardBut({kA, kB}, limits);
  EXPECT_EQ(shareAt(never_heard, 99 * kSecond), 0);
  EXPECT_GT(shareAt(never_heard, 101 * kSecond), 0);
  EXPECT_LT(shareAt(never_heard, 159 * kSecond), 1) << "a minute later, not four times as late";
  EXPECT_GT(shareAt(never_heard, 161 * kSecond), 1);
}

TEST_F(NeverHeardTest, RecordingsOfTheCalibrationCountToo) {
  train({start(7180, 1)}, {start(0, 7)});
  Limits limits;
  limits.firsts = {0, -1, 20 * kSecond};  // in one, B did not come
  NeverHeard never_heard = neverHeardBut({kA}, limits);
  EXPECT_EQ(shareAt(never_heard, 40 * kSecond), 0);
  EXPECT_GT(shareAt(never_heard, 41 * kSecond), 0);
  EXPECT_EQ(named(never_heard), Ids{kC});
  EXPECT_EQ(never_heard.suspects().front().reason.words,
            "not heard since the start, usually within 0 to 20 s");
}

TEST_F(NeverHeardTest, TheFirstEventOfAnyIdIsTheStart) {
  NeverHeard never_heard = neverHeardBut({});
  EXPECT_EQ(shareAt(never_heard, 1000 * kSecond), 0);
  for (const EventId id : {EventId{99}, kA}) {
    const std::int64_t start = id == kA ? 2000 * kSecond : 1000 * kSecond;
    never_heard.add({start, id});
    EXPECT_EQ(shareAt(never_heard, start + 5 * kSecond), 0);
    EXPECT_GT(shareAt(never_heard, start + 6 * kSecond), 0);
    EXPECT_EQ(named(never_heard).size(), id == kA ? 2U : 3U);
    never_heard.restart();
    EXPECT_EQ(never_heard.share(), 0);
  }
}

TEST_F(NeverHeardTest, WhatFellSilentIsNamedBeforeWhatNeverCameUnlessItWaitsForIt) {
  EXPECT_EQ(idsOf(afterSilenceOfB().suspects), (Ids{kB, kC}));
  EXPECT_EQ(afterSilenceOfB().evidence, "never heard, overdue");
  graph_->connect("/c", "/z", "/b");
  EXPECT_EQ(idsOf(afterSilenceOfB().suspects), (Ids{kC, kB}));
}

}  // namespace
}  // namespace self_awareness::core::evidence
