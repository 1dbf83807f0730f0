#include "self_awareness/core/evidence/limits/coverage.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "../tracks.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kLength = 100 * kSecond;

// A comes irregularly, B follows it, and C comes too seldom to be judged.
Events robot(unsigned seed) {
  return together({followed(seed, kLength), timer(kC, 0, kLength, 20 * kSecond)});
}

class CoverageTest : public testing::Test {
 protected:
  const Coverage& of(EventId id) {
    coverages_ = coverageOf(model_, {limits_, {}}, relations_, kWindow, knows_graph_);
    return coverages_.at(model_.componentIndex(id));
  }
  double& limit(const char* channel, EventId to, EventId from) {
    return ofTrack(limits_, model_, channel, to, from);
  }

  const Model model_{watch(countsOf({robot(1)}), countsOf({later(robot(2))}))};
  std::vector<double> limits_ = allTracks(model_, kNone);
  std::vector<Relation> relations_;
  bool knows_graph_ = false;
  std::vector<Coverage> coverages_;
};

TEST_F(CoverageTest, NobodyIsWatchedWithoutLimits) {
  for (const EventId id : {kA, kB, kC}) {
    EXPECT_EQ(of(id).component, kTypes[id].source);
    EXPECT_FALSE(of(id).isWatched());
    EXPECT_FALSE(of(id).late_answers);
    EXPECT_EQ(of(id).more_starts, 0U);
  }
  EXPECT_NEAR(of(kA).period, 0.2, 0.02);
  EXPECT_NEAR(of(kC).period, 20, 1e-9);
  EXPECT_EQ(of(kC).gaps, 8U);
  limits_.push_back(1);
  EXPECT_THROW(of(kA), std::invalid_argument) << "limits of another model";
}

TEST_F(CoverageTest, ADeathIsFoundTwoWindowsAfterTheSilenceIsBeyondItsLimit) {
  for (const double silence : {3, 3600}) {  // also one that is beyond all gaps
    limit(kOverdue, kA, kA) = silence;
    EXPECT_NEAR(of(kA).death_found_after.value_or(0), silence + 0.2, 1e-3);
  }
  EXPECT_TRUE(of(kA).isWatched());
  EXPECT_FALSE(of(kB).isWatched());
}

TEST_F(CoverageTest, ADeathIsFoundSoonerWhileItIsAsked) {
  limit(kDeadlines, kB, kA) = model_.tuning().least_sum;  // two requests without an answer
  EXPECT_NEAR(of(kB).found_when_asked.value_or(0), 3 * 0.2 + 0.3, 0.1);
  EXPECT_TRUE(of(kB).isWatched());
  EXPECT_FALSE(of(kB).death_found_after);
  EXPECT_FALSE(of(kA).found_when_asked);
}

TEST(CoverageOfTopics, ASilenceThatIsFoundFarLaterThanTheDeathIsNamed) {
  const std::vector<EventType> types{{"/a", "/x", "T"}, {"/a", "/y", "T"}};
  const auto start = [](unsigned seed) {
    return together(
        {timer(kA, 0, kLength, kSecond / 5), irregular(kB, 0, kLength, 3 * kSecond, seed)});
  };
  const Model model(watchAll(countsOf({start(1)}, types), countsOf({later(start(2))}, types)));
  const auto blindWith = [&](std::int64_t silence) {
    std::vector<double> limits = allTracks(model, kNone);
    ofTrack(limits, model, kOverdue, kA) = 1;
    ofTrack(limits, model, kOverdue, kB) = toSeconds(silence);
    const std::vector<Coverage> all = coverageOf(model, {limits, {}}, {}, kWindow, false);
    std::string told;
    for (const Coverage::Blind& blind : all.at(0).blind) {
      told += blind.about == "silence" ? blind.topic + " " + blind.why : "";
    }
    return told;
  };
  EXPECT_EQ(blindWith(30 * kSecond), "");
  EXPECT_EQ(blindWith(90 * kSecond).find("/y until 90 s, its longest pause in training was "), 0U)
      << blindWith(90 * kSecond);
}

TEST(FoundAfter, SaysTheSoonerOneWhileItIsNeeded) {
  Coverage coverage;
  EXPECT_EQ(foundAfter(coverage, " s"), "");
  coverage.found_when_asked = 0.6123;
  EXPECT_EQ(foundAfter(coverage, " s"), "0.61 s while it is needed");
  coverage.death_found_after = 1234;
  EXPECT_EQ(foundAfter(coverage, " s"), "1200 s, 0.61 s while it is needed");
  EXPECT_EQ(foundAfter(coverage, ""), "1200, 0.61 while it is needed");
  coverage.death_found_after = 0.5;
  EXPECT_EQ(foundAfter(coverage, ""), "0.5");
}

TEST_F(CoverageTest, WhoMayBeSilentIsNotWatchedSinceThatIsAccepted) {
  limit(kOverdue, kA, kA) = 3;
  const auto with = [&](const std::vector<bool>& may_be_silent) {
    return coverageOf(model_, {limits_, {}}, relations_, kWindow, knows_graph_, may_be_silent)
        .at(model_.componentIndex(kA));
  };
  EXPECT_TRUE(with({true, true, true}).accepted);
  EXPECT_FALSE(with({true, true, true}).isWatched());
  EXPECT_FALSE(with({false, true, true}).accepted);
  EXPECT_TRUE(with({false, true, true}).isWatched());
}

TEST_F(CoverageTest, ARelationThatIsJudgedFindsLateAnswersAndOneThatLacksStartsSaysHowMany) {
  relations_.resize(limits_.size());
  Relation& relation = relations_.at(indexOf(model_.tracks(), kPairs, kB, kA));
  relation.starts = 2;
  relation.starts_needed = 5;
  EXPECT_EQ(of(kB).more_starts, 3U);
  EXPECT_EQ(of(kA).more_starts, 0U);
  limit(kPairs, kB, kA) = 20;
  ASSERT_TRUE(of(kB).late_answers);
  EXPECT_GT(*of(kB).late_answers, 0.005) << "so small an effect is no fault";
  EXPECT_LT(*of(kB).late_answers, 0.06);
  EXPECT_EQ(of(kB).more_starts, 0U);
  EXPECT_FALSE(of(kB).isWatched()) << "it may be silent for ever";
}

TEST_F(CoverageTest, WhatTheGraphMightTellIsSaidWhereItIsNotKnown) {
  relations_.resize(limits_.size());
  Relation& relation = relations_.at(indexOf(model_.tracks(), kPairs, kB, kA));
  relation = {false, false, false, 0.2, 2, 0};
  EXPECT_EQ(lateAnswers(of(kB)), "") << "0.2 is more than the chance that is allowed";
  relation.starts = 3;
  EXPECT_EQ(lateAnswers(of(kB)), "with the graph");
  relation.starts_needed = 4;
  EXPECT_EQ(lateAnswers(of(kB)), "with the graph, or after 1 more start");
  relation.starts_needed = 5;
  knows_graph_ = true;
  EXPECT_EQ(lateAnswers(of(kB)), "after 2 more starts");
  relation.starts_needed = relation.starts + Coverage::kMostStarts + 1;
  EXPECT_EQ(lateAnswers(of(kB)), "");
  limit(kPairs, kB, kA) = 20;
  Coverage found;
  found.late_answers = 0.0595;
  EXPECT_EQ(lateAnswers(found), "from 60 ms");
}

}  // namespace
}  // namespace self_awareness::core::evidence
