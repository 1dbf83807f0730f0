#include "self_awareness/core/evidence/limits/limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../recordings.h"
#include "core/evidence/channel/scorer.h"
#include "self_awareness/core/evidence/limits/cross_fit.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kPeriod = 200 * kMillisecond;
const std::int64_t kShortestPart = toNanoseconds(Tuning{}.shortest_part);
const std::int64_t kLeastTime = toNanoseconds(Tuning{}.least_time);

// A comes irregularly, B follows it after a delay, and C comes at random.
Events robot(std::int64_t length, unsigned seed, std::int64_t delay = 20 * kMillisecond) {
  const Events asked = irregular(kA, 0, length, kPeriod, seed);
  return together(
      {asked, answers(kB, asked, delay), irregular(kC, 0, length, 50 * kMillisecond, seed + 100)});
}

std::shared_ptr<const Model> modelOf(const Events& first, const Events& second) {
  return std::make_shared<Model>(watch(countsOf({first}), countsOf({second})));
}

class LimitFinderTest : public testing::Test {
 protected:
  static void feed(LimitFinder& finder, const std::shared_ptr<const Model>& model,
                   const Events& events) {
    finder.startRecording(model);
    for (const Event& event : events) {
      finder.add(event);
    }
    finder.finish();
  }
  static Limits limitsOf(const std::shared_ptr<const Model>& model, const Events& events,
                         double budget = 0.5) {
    LimitFinder finder(model, {kWindow, 5 * kSecond, budget});
    feed(finder, model, events);
    finder.startSecondPass();
    feed(finder, model, events);
    return finder.limits();
  }
  double limit(const Limits& limits, Channel channel, EventId to, EventId from) const {
    const std::size_t track = indexOf(model_->tracks(), channel, to, from);
    EXPECT_LT(track, model_->tracks().size());
    return limits.tracks.at(track);
  }

  std::shared_ptr<const Model> model_ =
      modelOf(robot(100 * kSecond, 1), later(robot(100 * kSecond, 2)));
};

TEST_F(LimitFinderTest, AreFiniteAndAboveAllThatWasSeen) {
  const Events normal = robot(200 * kSecond, 3);
  const Limits limits = limitsOf(model_, normal);
  ASSERT_EQ(limits.tracks.size(), model_->tracks().size());
  EXPECT_GE(limits.linker, 1);
  Scorer scorer(model_, kWindow);
  std::int64_t end = kWindow;
  for (const Event& event : normal) {
    for (; event.stamp >= end; end += kWindow) {
      const Sum sum = sumUp(scorer.closeWindow(end), *model_, limits);
      if (end > 5 * kSecond) {
        EXPECT_LE(sum.largest, 1) << end;
        EXPECT_LT(sum.linker, limits.linker) << end;
      }
    }
    scorer.add(event);
  }
  for (std::size_t track = 0; track < limits.tracks.size(); ++track) {
    if (!std::isnan(limits.tracks[track])) {
      EXPECT_GE(limits.tracks[track], model_->leastLimit(track));
      EXPECT_GT(limits.tracks[track], 0);
    }
  }
}

TEST_F(LimitFinderTest, ASmallerBudgetHasHigherLimits) {
  const Events normal = robot(200 * kSecond, 3);
  const Limits lax = limitsOf(model_, normal, 5);
  const Limits strict = limitsOf(model_, normal, 0.05);
  for (std::size_t track = 0; track < lax.tracks.size(); ++track) {
    EXPECT_FALSE(strict.tracks[track] < lax.tracks[track]) << track;
  }
  EXPECT_GT(limit(strict, Channel::kOverdue, kA, kA), limit(lax, Channel::kOverdue, kA, kA));
}

TEST_F(LimitFinderTest, APairThatMisleadsIsNotJudged) {
  const Limits holds = limitsOf(model_, robot(200 * kSecond, 3));
  EXPECT_TRUE(std::isfinite(limit(holds, Channel::kDelay, kB, kA)));
  EXPECT_TRUE(std::isfinite(limit(holds, Channel::kSlowDelay, kB, kA)));
  // The phase held in both halves of the training by chance. It never does in another recording,
  // so there is no evidence, only less information.
  LimitFinder finder(model_, {kWindow, 5 * kSecond, 0.5});
  for (const bool first : {true, false}) {
    feed(finder, model_, robot(200 * kSecond, 3));
    feed(finder, model_, robot(100 * kSecond, 4, 60 * kMillisecond));
    if (first) {
      finder.startSecondPass();
    }
  }
  const Limits lost = finder.limits();
  EXPECT_TRUE(std::isnan(limit(lost, Channel::kDelay, kB, kA)));
  EXPECT_TRUE(std::isnan(limit(lost, Channel::kSlowDelay, kB, kA)));
  EXPECT_TRUE(std::isfinite(limit(lost, Channel::kOverdue, kB, kB)));
}

TEST_F(LimitFinderTest, APairWhoseEvidenceRunsAwayIsNotJudged) {
  Events drifted = robot(200 * kSecond, 3);
  for (Event& event : drifted) {
    if (event.id == kB && event.stamp > 190 * kSecond) {
      event.stamp += 40 * kMillisecond;
    }
  }
  const Limits lost = limitsOf(model_, together({drifted}));
  EXPECT_TRUE(std::isnan(limit(lost, Channel::kDelay, kB, kA)));
}

TEST_F(LimitFinderTest, AnAnswerThatIsAskedForTooSeldomIsNotJudged) {
  for (const auto& [period, judged] : {std::pair(kSecond, true), std::pair(4 * kSecond, false)}) {
    const auto slow = [&, p = period](unsigned seed) {
      const Events asked = irregular(kA, 0, 110 * p, p, seed);
      return together({asked, answers(kB, asked, 20 * kMillisecond)});
    };
    model_ = modelOf(slow(1), later(slow(2)));
    const double found = limit(limitsOf(model_, slow(3)), Channel::kAnswer, kB, kA);
    EXPECT_EQ(std::isfinite(found), judged) << period;
  }
}

TEST_F(LimitFinderTest, LessThanTheLeastTimeIsTooLittle) {
  LimitFinder finder(model_, {kWindow, 5 * kSecond, 0.5});
  // Two recordings, each with 5 s to settle: together they are a little too short.
  feed(finder, model_, robot(kLeastTime / 2 + 4 * kSecond, 3));
  feed(finder, model_, later(robot(kLeastTime / 2 + 4 * kSecond, 4)));
  EXPECT_THROW(finder.startSecondPass(), std::invalid_argument);
  feed(finder, model_, later(robot(9 * kSecond, 5), 2 * kStart));
  EXPECT_NO_THROW(finder.startSecondPass());
}

TEST_F(LimitFinderTest, WhatTheTrainingShowedDoesNotReplaceOtherRecordings) {
  const CrossFit models(
      watch(countsOf({robot(100 * kSecond, 1)}), countsOf({later(robot(100 * kSecond, 2))})));
  LimitFinder finder(models.model(), {kWindow, 5 * kSecond, 0.5});
  feed(finder, models.judging(0), robot(100 * kSecond, 1));
  feed(finder, models.judging({}), later(robot(20 * kSecond, 3), 2 * kStart));
  EXPECT_THROW(finder.startSecondPass(), std::invalid_argument);
  feed(finder, models.judging({}), later(robot(60 * kSecond, 4), 3 * kStart));
  EXPECT_NO_THROW(finder.startSecondPass());
}

TEST_F(LimitFinderTest, AModelThatWatchesNothingIsSaidToBeTheReason) {
  model_ = modelOf(timer(kA, 0, 10 * kSecond, kSecond), timer(kA, 0, 10 * kSecond, kSecond));
  ASSERT_TRUE(model_->tracks().empty());
  LimitFinder finder(model_, {kWindow, 5 * kSecond, 0.5});
  feed(finder, model_, robot(100 * kSecond, 3));
  try {
    finder.startSecondPass();
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("train it on more"), std::string::npos);
  }
}

TEST_F(LimitFinderTest, CountsTheWindowsOfTheFirstPassAfterSettling) {
  LimitFinder finder(model_, {kWindow, 5 * kSecond, 0.5});
  const Events normal = timer(kA, 0, 60 * kSecond, kPeriod);
  feed(finder, model_, normal);
  EXPECT_EQ(finder.windows(), 548U);  // the recording ends before the last window does
  finder.startSecondPass();
  feed(finder, model_, normal);
  EXPECT_EQ(finder.windows(), 548U);
}

TEST_F(LimitFinderTest, WithoutASecondPassThereAreNoLimits) {
  LimitFinder finder(model_, {kWindow, 5 * kSecond, 0.5});
  feed(finder, model_, robot(100 * kSecond, 3));
  EXPECT_THROW(finder.limits(), std::logic_error);
  finder.startSecondPass();
  EXPECT_THROW(finder.limits(), std::logic_error);
  feed(finder, model_, robot(100 * kSecond, 3));
  EXPECT_NO_THROW(finder.limits());
}

TEST_F(LimitFinderTest, WhatRecordingsSayElsewhereAddsUp) {
  // Pairs mislead in the second recording, and the third ends within a block.
  const std::vector<Events> recordings{robot(60 * kSecond, 3),
                                       robot(110 * kSecond, 4, 60 * kMillisecond),
                                       robot(19 * kSecond, 5), robot(45 * kSecond, 6)};
  const LimitFinder::Parameters parameters{kWindow, 5 * kSecond, 0.5};
  LimitFinder alone(model_, parameters);
  LimitFinder sum(model_, parameters);
  for (const bool first : {true, false}) {
    std::vector<LimitFinder::Findings> elsewhere;
    for (const Events& recording : recordings) {
      feed(alone, model_, recording);
      LimitFinder part(model_, parameters);
      if (!first) {
        part.startSecondPass(sum.trackLimits());
      }
      feed(part, model_, recording);
      elsewhere.push_back(part.findings());
    }
    std::reverse(elsewhere.begin(), elsewhere.end());
    for (const LimitFinder::Findings& findings : elsewhere) {
      sum.merge(findings);
    }
    if (first) {
      alone.startSecondPass();
      sum.startSecondPass();
    }
  }
  EXPECT_EQ(sum.windows(), alone.windows());
  const Limits a = alone.limits();
  const Limits b = sum.limits();
  EXPECT_EQ(a.linker, b.linker);
  ASSERT_EQ(a.tracks.size(), b.tracks.size());
  EXPECT_TRUE(std::any_of(a.tracks.begin(), a.tracks.end(), [](double x) { return x != x; }));
  EXPECT_TRUE(std::any_of(a.tracks.begin(), a.tracks.end(), [](double x) { return x == x; }));
  for (std::size_t track = 0; track < a.tracks.size(); ++track) {
    EXPECT_TRUE(a.tracks[track] == b.tracks[track] ||
                (std::isnan(a.tracks[track]) && std::isnan(b.tracks[track])))
        << track;
  }
}

TEST_F(LimitFinderTest, FindingsDoNotGrowWithTheRecording) {
  LimitFinder finder(model_, {kWindow, 5 * kSecond, 0.5});
  for (const std::int64_t parts : {1, 4, 16, 17, 40}) {
    feed(finder, model_, robot(parts * kShortestPart + 5 * kSecond, 3));
    const LimitFinder::Recording& recording = finder.findings().back();
    EXPECT_LE(recording.parts.size(), LimitFinder::kMostParts);
    EXPECT_GE(2 * recording.parts.size(), std::min<std::size_t>(parts, LimitFinder::kMostParts));
    std::uint64_t windows = 0;
    for (const LimitFinder::Recording::Part& part : recording.parts) {
      // All are of one length, but the last one.
      EXPECT_TRUE(&part == &recording.parts.back() ||
                  part.windows == recording.parts.front().windows);
      EXPECT_LE(part.windows, recording.parts.front().windows);
      EXPECT_EQ(part.evidence.size(), model_->tracks().size());
      EXPECT_EQ(part.longest_gaps.size(), model_->size());
      windows += part.windows;
    }
    EXPECT_EQ(windows, recording.windows);
    EXPECT_EQ(recording.said.size(), model_->tracks().size());
  }
}

TEST_F(LimitFinderTest, PartsTogetherSayWhatTheRecordingDoes) {
  const auto largestOf = [&](std::int64_t length) {
    LimitFinder finder(model_, {kWindow, 5 * kSecond, 0.5});
    Events events = robot(length, 3);
    events.erase(std::remove_if(events.begin(), events.end(),  // A is gone for a second
                                [](const Event& event) {
                                  return event.id == kA && event.stamp > 50 * kSecond &&
                                         event.stamp < 51 * kSecond;
                                }),
                 events.end());
    feed(finder, model_, events);
    std::int64_t longest = 0;
    for (const LimitFinder::Recording::Part& part : finder.findings().at(0).parts) {
      longest = std::max(longest, part.longest_gaps[kA]);
    }
    return longest;
  };
  EXPECT_GE(largestOf(60 * kSecond), kSecond);
  EXPECT_GE(largestOf(40 * kShortestPart), largestOf(60 * kSecond));
}

TEST_F(LimitFinderTest, AStepOfTheClockIsTheStartOfAnotherRecording) {
  const Events first = robot(60 * kSecond, 3);
  const Events second = robot(60 * kSecond, 4);  // starts at 0 again
  LimitFinder apart(model_, {kWindow, 5 * kSecond, 0.5});
  LimitFinder stepped(model_, {kWindow, 5 * kSecond, 0.5});
  Events joined = first;
  joined.insert(joined.end(), second.begin(), second.end());
  for (int pass = 0; pass < 2; ++pass) {
    feed(apart, model_, first);
    feed(apart, model_, second);
    feed(stepped, model_, joined);
    if (pass == 0) {
      apart.startSecondPass();
      stepped.startSecondPass();
    }
  }
  EXPECT_EQ(apart.windows(), stepped.windows());
  const Limits a = apart.limits();
  const Limits b = stepped.limits();
  EXPECT_EQ(a.linker, b.linker);
  for (std::size_t track = 0; track < a.tracks.size(); ++track) {
    EXPECT_TRUE(a.tracks[track] == b.tracks[track] ||
                (std::isnan(a.tracks[track]) && std::isnan(b.tracks[track])))
        << track;
  }
}

TEST_F(LimitFinderTest, WithoutAReasonNoRelationIsJudged) {
  // All of one start: the answers may be chance, but a message can get from A to B.
  const Events normal = robot(200 * kSecond, 3);
  const auto delay = [&](const SourceGraph& graph) {
    const auto model = std::make_shared<Model>(
        watch(countsOf({robot(100 * kSecond, 1)}), countsOf({robot(100 * kSecond, 2)})));
    LimitFinder finder(model, {kWindow, 5 * kSecond, 0.5}, graph);
    for (const bool first : {true, false}) {
      feed(finder, model, normal);
      if (first) {
        finder.startSecondPass();
      }
    }
    const std::size_t track = indexOf(model->tracks(), Channel::kDelay, kB, kA);
    EXPECT_LT(track, model->tracks().size());
    EXPECT_EQ(finder.relations().at(track).watched,
              std::isfinite(finder.limits().tracks.at(track)));
    for (std::size_t k = 0; k < model->tracks().size(); ++k) {
      if (model->tracks()[k].to == model->tracks()[k].from) {
        EXPECT_TRUE(finder.relations()[k].watched) << "the own history needs no reason";
      }
    }
    return finder.relations().at(track);
  };
  const Relation alone = delay({});
  EXPECT_FALSE(alone.watched);
  EXPECT_EQ(alone.starts, 1U);
  EXPECT_EQ(alone.starts_needed, 2U) << "it is irregular";
  SourceGraph graph;
  graph.connect("/a", "/x", "/b");
  const Relation reached = delay(graph);
  EXPECT_TRUE(reached.watched);
  EXPECT_TRUE(reached.reaches && reached.irregular);
  EXPECT_EQ(reached.starts_needed, 0U);
}

TEST_F(LimitFinderTest, RecordingsThatWereNotTrainedOnCountAsStarts) {
  const auto model = std::make_shared<Model>(
      watch(countsOf({robot(100 * kSecond, 1)}), countsOf({robot(100 * kSecond, 2)})));
  LimitFinder finder(model, {kWindow, 5 * kSecond, 0.5});
  feed(finder, model, later(robot(100 * kSecond, 3)));
  finder.startSecondPass();
  const std::size_t track = indexOf(model->tracks(), Channel::kDelay, kB, kA);
  EXPECT_EQ(finder.relations().at(track).starts, 2U);
  EXPECT_TRUE(finder.relations().at(track).watched);
}

TEST_F(LimitFinderTest, MoreFalseAlarmsAreExpectedOfALargerBudget) {
  const auto expected = [&](double budget) {
    LimitFinder finder(model_, {kWindow, 5 * kSecond, budget});
    for (const bool first : {true, false}) {
      for (unsigned seed = 3; seed < 9; ++seed) {
        feed(finder, model_, later(robot(200 * kSecond, seed), seed * kStart));
      }
      if (first) {
        finder.startSecondPass();
      }
    }
    return finder.expectedRate();
  };
  const double little = expected(0.05);
  const double much = expected(50);
  EXPECT_GT(little, 0);
  EXPECT_LT(little, much);
  EXPECT_LE(much, 50);
}

TEST_F(LimitFinderTest, RefusesImpossibleValues) {
  EXPECT_THROW(LimitFinder(model_, {0, 0, 0.5}), std::invalid_argument);
  EXPECT_THROW(LimitFinder(model_, {kWindow, -1, 0.5}), std::invalid_argument);
  EXPECT_THROW(LimitFinder(model_, {kWindow, 0, 0}), std::invalid_argument);
  EXPECT_THROW(LimitFinder(model_, {kWindow, 0, std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace self_awareness::core::evidence
