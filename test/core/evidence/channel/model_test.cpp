#include "self_awareness/core/evidence/channel/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "../tracks.h"
#include "core/evidence/count/log_bins.h"

namespace self_awareness::core::evidence {
namespace {

const Statistics kNothing = countsOf({});

// Gaps [ns] as the model knows them: the middle of their bins, but at most the longest gap.
std::vector<double> binnedGaps(const Events& events) {
  std::vector<double> gaps;
  double longest = 0;
  for (std::size_t k = 1; k < events.size(); ++k) {
    const std::int64_t gap = events[k].stamp - events[k - 1].stamp;
    longest = std::max(longest, static_cast<double>(gap));
    gaps.push_back(log_bins::middle(log_bins::bin(gap)));
  }
  for (double& gap : gaps) {
    gap = std::min(gap, longest);
  }
  return gaps;
}

TEST(EvidenceModel, NeedsAnEvent) {
  EXPECT_THROW(Model(watch({}, {})), std::invalid_argument);
}

TEST(EvidenceModel, OverdueIsTheLiteralSumOverTheGaps) {
  for (const Events& events : {irregular(kA, 0, 60 * kSecond, 300 * kMillisecond, 3),
                               timer(kA, 0, 60 * kSecond, 100 * kMillisecond)}) {
    const Model model(watch(countsOf({events}), kNothing));
    const std::vector<double> gaps = binnedGaps(events);
    const auto b = static_cast<double>(model.longestGap(kA));
    double all = b;
    for (const double gap : gaps) {
      all += gap;
    }
    for (const std::int64_t milliseconds : {1, 50, 200, 300, 700, 1500, 4000}) {
      const std::int64_t age = milliseconds * kMillisecond;
      double left = b * std::exp(-static_cast<double>(age) / b);
      for (const double gap : gaps) {
        left += std::max(gap - static_cast<double>(age), 0.0);
      }
      EXPECT_NEAR(model.overdue(kA, age), -std::log(left / all), 1e-9) << milliseconds;
    }
  }
}

TEST(EvidenceModel, OverdueRisesFromZeroWithoutEnd) {
  const Model model(
      watch(countsOf({irregular(kA, 0, 60 * kSecond, 300 * kMillisecond, 3)}), kNothing));
  EXPECT_NEAR(model.overdue(kA, 0), 0, 1e-12);
  EXPECT_NEAR(model.overdue(kA, -kSecond), 0, 1e-12);
  double before = 0;
  for (std::int64_t age = kMillisecond; age < 3600 * kSecond; age += age / 4 + 1) {
    const double now = model.overdue(kA, age);
    ASSERT_GT(now, before) << age;
    ASSERT_TRUE(std::isfinite(now)) << age;
    before = now;
  }
}

TEST(EvidenceModel, ATypeThatNeverRepeatedHasNoEvidence) {
  const Model model(watch(countsOf({{{0, kA}, {kSecond, kB}, {2 * kSecond, kB}}}), kNothing));
  EXPECT_EQ(model.overdue(kA, 3600 * kSecond), 0);
  EXPECT_EQ(model.logSurvival(kA, 3600 * kSecond), 0);
  EXPECT_EQ(model.longestGap(kA), 0);
  EXPECT_EQ(model.longestGap(kB), kSecond);
  EXPECT_TRUE(model.tracks().empty());
}

TEST(EvidenceModel, SurvivalIsTheShareOfGapsAndATailBeyondThem) {
  const Model model(
      watch(countsOf({timer(kA, 0, 10 * kSecond + 1, 100 * kMillisecond)}), kNothing));
  EXPECT_NEAR(model.logSurvival(kA, 200 * kMillisecond), -2 - std::log(101), 1e-12);
  EXPECT_NEAR(model.logSurvival(kA, 50 * kMillisecond),
              std::log(100 + std::exp(-0.5)) - std::log(101), 1e-12);
}

TEST(EvidenceModel, ANumberOutOfItsRangeIsRefused) {
  Watched watched = watch(startOf(followed(1), 1), startOf(followed(2), 2));
  EXPECT_TRUE(Model(watched).tuning() == watched.tuning);
  watched.tuning.least_effect = -1e-9;
  EXPECT_THROW(Model{watched}, std::invalid_argument);
  watched.tuning.least_effect = 0;
  EXPECT_NO_THROW(Model{watched});
  watched.tuning.least_effect_of_period = 1;
  EXPECT_THROW(Model{watched}, std::invalid_argument);
}

TEST(EvidenceModel, ATrackOfNoChannelIsRefused) {
  Watched watched = watch(startOf(followed(1), 1), startOf(followed(2), 2));
  watched.tracks.push_back({nullptr, kA, kA});
  EXPECT_THROW(Model{watched}, std::invalid_argument);
}

TEST(EvidenceModel, KnowsTheLongestTimeWithoutAnyEvent) {
  const Model model(watch(countsOf({{{0, kA}, {300, kB}, {400, kA}}}),
                          countsOf({later({{0, kB}, {250, kB}, {600, kA}})})));
  EXPECT_EQ(model.longestSilence(), 350);
  EXPECT_EQ(Model(watch(countsOf({}), kNothing)).longestSilence(), 0);
}

TEST(EvidenceModel, TheTracksStayWhateverProbabilitiesWereLearnedFrom) {
  const Statistics first = startOf(followed(1), 1);
  const Watched watched = watch(first, startOf(followed(2), 2));
  const Model both(watched);
  const Model half(watched, Model::Learned::kFirst);
  const Model other(watched, Model::Learned::kSecond);
  expectSameTracks(both.tracks(), half.tracks());
  EXPECT_NE(half.overdue(kA, kSecond), other.overdue(kA, kSecond));
  EXPECT_DOUBLE_EQ(half.overdue(kA, kSecond), Model(watch(first, {})).overdue(kA, kSecond));
}

TEST(EvidenceModel, AHalfMayLackAnEventType) {
  const Statistics second =  // B alone, so that its id is another one
      countsOf({timer(0, 0, 10 * kSecond, 100 * kMillisecond)}, {kTypes[kB]});
  const Statistics first = countsOf({timer(kA, 0, 10 * kSecond, 100 * kMillisecond)}, 1);
  const Model model(watch(first, second), Model::Learned::kSecond);
  EXPECT_EQ(model.overdue(kA, kSecond), 0);
  EXPECT_GT(model.overdue(kB, kSecond), 1);
}

TEST(EvidenceModel, TheLongestGapsAreTheUsualOnesExactly) {
  // 5 Hz, of which one gap in fifty is 13 ms longer: within one bin.
  Events events;
  std::int64_t stamp = 0;
  for (int i = 0; i <= 1000; ++i) {
    events.push_back({stamp, kA});
    stamp += (i % 50 == 7 ? 213 : 200) * kMillisecond;
  }
  const Model model(watch(countsOf({events}), kNothing));
  EXPECT_DOUBLE_EQ(model.usualDelay(kA, kA, 1), 213 * kMillisecond);
  EXPECT_DOUBLE_EQ(model.usualDelay(kA, kA, 0.99), 213 * kMillisecond);
  EXPECT_DOUBLE_EQ(model.usualDelay(kA, kA, 0.975), 200 * kMillisecond);
  EXPECT_DOUBLE_EQ(model.meanGap(kA), 200.26 * kMillisecond);
  // The shorter ones are known as exactly as their bin, and never longer than the longest.
  EXPECT_GT(model.usualDelay(kA, kA, 0.01), 190 * kMillisecond);
  EXPECT_LT(model.usualDelay(kA, kA, 0.01), 200 * kMillisecond);
  EXPECT_LT(model.usualDelay(kA, kA, 0.96), 213 * kMillisecond);
  EXPECT_EQ(model.usualDelay(kB, kB, 0.5), 0);
  EXPECT_EQ(model.meanGap(kB), 0);
}

TEST(EvidenceModel, UsualDelaysAreEstimatedWithinTheirBin) {
  // Delays of 20 to 23.7 ms, which fill the bin from 20 ms on evenly.
  const Events asked = timer(kA, 0, 100 * kSecond, 100 * kMillisecond);
  Events answered = answers(kB, asked, 20 * kMillisecond);
  for (std::size_t k = 0; k < answered.size(); ++k) {
    answered[k].stamp += static_cast<std::int64_t>(k % 38) * kMillisecond / 10;
  }
  const Statistics half = countsOf({together({asked, answered})}, 2);
  const Model model(watch(half, half));
  for (const double share : {0.05, 0.3, 0.5, 0.8, 0.95}) {
    EXPECT_NEAR(model.usualDelay(kA, kB, share), 20e6 + 3.8e6 * share, 1e5) << share;
  }
}

}  // namespace
}  // namespace self_awareness::core::evidence
