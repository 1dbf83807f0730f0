#include "self_awareness/core/evidence/limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/evidence/scorer.h"
#include "recordings.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kPeriod = 200 * kMillisecond;

// A comes irregularly, B follows it after a delay, and C comes at random.
Events robot(std::int64_t length, unsigned seed, std::int64_t delay = 20 * kMillisecond) {
  const Events asked = irregular(kA, 0, length, kPeriod, seed);
  return together(
      {asked, answers(kB, asked, delay), irregular(kC, 0, length, 50 * kMillisecond, seed + 100)});
}

std::shared_ptr<const Model> modelOf(const Events& first, const Events& second) {
  return std::make_shared<Model>(watch(countsOf({first}), countsOf({second})));
}

BlockMaxima maximaOf(const std::vector<double>& values) {
  BlockMaxima maxima;
  for (const double value : values) {
    maxima.add(value);
  }
  return maxima;
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

  std::shared_ptr<const Model> model_ = modelOf(robot(100 * kSecond, 1), robot(100 * kSecond, 2));
};

TEST(GumbelLimit, IsFittedByLMoments) {
  // Of 1, 2, 4: l1 = 7/3, b1 = (0 * 1 + 1/2 * 2 + 1 * 4) / 3 = 5/3, l2 = 2 b1 - l1 = 1.
  const double scale = 1 / std::log(2.0);
  const double location = 7.0 / 3 - 0.5772156649015329 * scale;
  for (const double probability : {0.5, 0.01, 1e-6}) {
    const double expected = location - scale * std::log(-std::log(1 - probability));
    EXPECT_NEAR(gumbelLimit(maximaOf({4, 1, 2}), probability), expected, 1e-9);  // in any order
  }
}

TEST(GumbelLimit, FindsTheQuantilesOfAGumbelDistribution) {
  std::mt19937 random(1);
  std::extreme_value_distribution<double> gumbel(5, 2);
  BlockMaxima maxima;
  for (int k = 0; k < 20000; ++k) {
    maxima.add(std::max(gumbel(random), 0.0));
  }
  for (const double probability : {0.5, 0.1, 0.001, 1e-6}) {
    const double expected = 5 - 2 * std::log(-std::log1p(-probability));
    EXPECT_NEAR(gumbelLimit(maxima, probability), expected, 0.02 * expected) << probability;
  }
}

TEST(GumbelLimit, OfMaximaThatNeverVaryIsTheirValue) {
  EXPECT_NEAR(gumbelLimit(maximaOf({3, 3, 3, 3}), 1e-6), 3, 1e-9);
}

TEST(OverdueAge, ExtrapolatesTheExcessOverTheShortestOfTheLongestGaps) {
  // Three gaps in 1000 ns, and one in 10000 ns allowed: 30 times rarer, with a mean excess of 2
  // ns.
  EXPECT_NEAR(overdueAge({10, 8, 6}, 1000, 1e-4), 6 + 2 * std::log(30), 1e-9);
}

TEST(OverdueAge, IsBeyondTheLongestGapThatWasSeen) {
  EXPECT_NEAR(overdueAge({10, 8, 6}, 1000, 1.0), 11, 1e-9);
  EXPECT_NEAR(overdueAge({100, 2, 1}, 1000, 1e-3), 110, 1e-9);
}

TEST(OverdueAge, LooksAtTheTwentyLongestGaps) {
  std::vector<std::int64_t> gaps;
  for (std::int64_t gap = 40; gap > 20; --gap) {
    gaps.push_back(gap);
  }
  const double of_twenty = overdueAge(gaps, 1000, 1e-4);
  EXPECT_NEAR(of_twenty, 21 + 9.5 * std::log(200), 1e-9);
  gaps.push_back(1);
  EXPECT_EQ(overdueAge(gaps, 1000, 1e-4), of_twenty);
}

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
    model_ = modelOf(slow(1), slow(2));
    const double found = limit(limitsOf(model_, slow(3)), Channel::kAnswer, kB, kA);
    EXPECT_EQ(std::isfinite(found), judged) << period;
  }
}

TEST_F(LimitFinderTest, LessThanFiveBlocksAreTooLittle) {
  LimitFinder finder(model_, {kWindow, 5 * kSecond, 0.5});
  // Two recordings, each with 5 s to settle, 20 s that count, and a rest that is shorter than a
  // block.
  feed(finder, model_, robot(34 * kSecond, 3));
  feed(finder, model_, robot(34 * kSecond, 4));
  EXPECT_THROW(finder.startSecondPass(), std::invalid_argument);
  feed(finder, model_, robot(16 * kSecond, 5));
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
  const Events normal = robot(136 * kSecond, 3);  // 13 blocks
  const auto cells = [&] {
    std::size_t number = 0;
    for (const BlockMaxima& maxima : finder.findings().maxima) {
      number += maxima.cells().size();
    }
    return number;
  };
  feed(finder, model_, normal);
  EXPECT_EQ(finder.findings().blocks, 13U);
  const std::size_t of_one = cells();
  EXPECT_GT(of_one, 0U);
  for (int k = 0; k < 9; ++k) {
    feed(finder, model_, normal);
  }
  const LimitFinder::Findings findings = finder.findings();
  EXPECT_EQ(findings.blocks, 130U);
  EXPECT_EQ(cells(), of_one);
  for (std::size_t track = 0; track < findings.maxima.size(); ++track) {
    const bool overdue = model_->tracks()[track].channel == Channel::kOverdue;
    EXPECT_EQ(findings.maxima[track].number(), overdue ? 0U : 130U) << track;
  }
  for (const std::vector<std::int64_t>& gaps : findings.longest_gaps) {
    EXPECT_LE(gaps.size(), Statistics::kLongestGaps);
  }
}

TEST_F(LimitFinderTest, WhatWasFoundForAnotherModelIsRefused) {
  LimitFinder finder(model_, {kWindow, 5 * kSecond, 0.5});
  const auto other = modelOf(timer(kA, 0, 100 * kSecond, kPeriod), {});
  const LimitFinder of_other(other, {kWindow, 5 * kSecond, 0.5});
  EXPECT_THROW(finder.merge(of_other.findings()), std::invalid_argument);
  EXPECT_THROW(finder.startSecondPass(Limits{{1.0}, 1.0}), std::invalid_argument);
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

TEST_F(LimitFinderTest, RefusesImpossibleValues) {
  EXPECT_THROW(LimitFinder(model_, {0, 0, 0.5}), std::invalid_argument);
  EXPECT_THROW(LimitFinder(model_, {kWindow, -1, 0.5}), std::invalid_argument);
  EXPECT_THROW(LimitFinder(model_, {kWindow, 0, 0}), std::invalid_argument);
  EXPECT_THROW(LimitFinder(model_, {kWindow, 0, std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace self_awareness::core::evidence
