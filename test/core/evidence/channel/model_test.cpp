#include "self_awareness/core/evidence/channel/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "../recordings.h"
#include "core/evidence/count/log_bins.h"

namespace self_awareness::core::evidence {
namespace {

const Statistics kNothing = countsOf({});
// More than chance [standard deviations].
constexpr double kLeastSurprise = 3;

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

// Statistics with the recent counts of one event type.
Statistics ofRate(std::uint64_t sum, std::uint64_t squares, std::uint64_t windows) {
  Statistics counts;
  counts.intern(kTypes[kA]);
  counts.type(kA).rate_sum = sum;
  counts.type(kA).rate_squares = squares;
  counts.addRateWindows(windows);
  return counts;
}

// B comes 20 or 40 ms after A, which comes at random.
Statistics pairCounts(unsigned seed) {
  const Events asked = irregular(kA, 0, 100 * kSecond, 200 * kMillisecond, seed);
  Events answered = answers(kB, asked, 20 * kMillisecond);
  for (std::size_t k = 0; k < answered.size(); k += 3) {
    answered[k].stamp += 20 * kMillisecond;
  }
  return countsOf({later(together({asked, answered}), seed * kStart)}, 2);
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

TEST(EvidenceModel, OverdueWeighsGapsByTheirLength) {
  // 1000 gaps of 100 ms and one of 10 s: a tenth of the time lies in the long one.
  Events events = timer(kA, 0, 100 * kSecond + 1, 100 * kMillisecond);
  events.push_back({events.back().stamp + 10 * kSecond, kA});
  const Model model(watch(countsOf({events}), kNothing));
  const double of_time = std::exp(-model.overdue(kA, kSecond));
  const double of_gaps = std::exp(model.logSurvival(kA, kSecond));
  EXPECT_NEAR(of_time, 0.15, 0.02);  // the long gap and the tail beyond it
  EXPECT_NEAR(of_gaps, 0.002, 0.0002);
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

TEST(EvidenceModel, RateIsTheNumberOfSpreadsAboveTheMean) {
  // Mean 4, variance 1; min(1, 4 / 4) + 1/4 more, and 4 % of the mean.
  const double spread = std::sqrt(1 + 1 + 0.25 + 0.16 * 0.16);
  const Model often(watch(ofRate(40, 170, 10), {}));
  EXPECT_NEAR(often.rate(kA, 7), 3 / spread, 1e-12);
  EXPECT_NEAR(often.rate(kA, 1), -3 / spread, 1e-12);
  EXPECT_NEAR(often.usualCount(kA, 2), 4 + 2 * spread, 1e-12);
  // Mean 0.4, variance 0.24, min(1, 0.1) + 1/4 more.
  const Model rarely(watch(ofRate(4, 4, 10), {}));
  EXPECT_NEAR(rarely.rate(kA, 1), 0.6 / std::sqrt(0.59 + 0.016 * 0.016), 1e-12);
  // The halves add up.
  const Model halves(watch(ofRate(10, 45, 3), ofRate(30, 125, 7)));
  EXPECT_NEAR(halves.rate(kA, 7), 3 / spread, 1e-12);
}

TEST(EvidenceModel, ARateThatWandersByAFewPercentIsNoFault) {
  // 1000 in 2 s, always the same in training: 5 % less is hardly unusual, a fifth less is.
  const Model model(watch(ofRate(10000, 10000000, 10), {}));
  EXPECT_GT(model.rate(kA, 950), -2);
  EXPECT_LT(model.rate(kA, 800), -4);
}

TEST(EvidenceModel, MissRateIsNeverQuiteZeroOrOne) {
  EXPECT_DOUBLE_EQ(missRate(99, 80), 0.195);
  EXPECT_DOUBLE_EQ(missRate(99, 99), 0.005);
  EXPECT_DOUBLE_EQ(missRate(0, 0), 0.5);
  EXPECT_DOUBLE_EQ(missRate(99, 0), 0.995);
}

TEST(EvidenceModel, AnswersAreALogLikelihoodRatio) {
  const Events asked = irregular(kA, 0, 100 * kSecond, 100 * kMillisecond, 1);
  Events answered = answers(kB, asked, 20 * kMillisecond);
  std::size_t index = 0;  // every sixth answer is left out
  answered.erase(std::remove_if(answered.begin(), answered.end(),
                                [&](const Event&) { return index++ % 6 == 0; }),
                 answered.end());
  const Statistics counts = countsOf({together({asked, answered})}, 2);
  const Model model(watch(counts, counts));
  const std::size_t track = indexOf(model.tracks(), Channel::kAnswer, kB, kA);
  ASSERT_LT(track, model.tracks().size());
  const double usual = missRate(2 * counts.type(kA).gaps, 2 * counts.answers(kA, kB));
  EXPECT_NEAR(usual, 1.0 / 6, 0.002);
  EXPECT_DOUBLE_EQ(model.missRate(track), usual);
  // The fault takes away half of the answers that came.
  EXPECT_NEAR(model.answered(track), std::log(0.5), 1e-12);
  EXPECT_NEAR(model.missed(track), std::log((usual + (1 - usual) / 2) / usual), 1e-12);
  // In normal operation the sum of the ratios falls, with the fault it rises.
  EXPECT_LT(usual * model.missed(track) + (1 - usual) * model.answered(track), 0);
  EXPECT_GT(7.0 / 12 * model.missed(track) + 5.0 / 12 * model.answered(track), 0);
  EXPECT_GE(model.leastLimit(track), 4 * model.missed(track));
}

TEST(EvidenceModel, SurpriseIsStandardisedByWhatTheOtherHalfFinds) {
  // B comes 20 or 40 ms after A, and one in fifty 110 ms.
  const Events asked = irregular(kA, 0, 200 * kSecond, 200 * kMillisecond, 1);
  Events answered = answers(kB, asked, 20 * kMillisecond);
  for (std::size_t k = 0; k < answered.size(); ++k) {
    answered[k].stamp += k % 50 == 7 ? 90 * kMillisecond : k % 3 == 0 ? 20 * kMillisecond : 0;
  }
  const Statistics half = countsOf({together({asked, answered})}, 2);
  const Model model(watch(half, half), Model::Learned::kFirst);
  const std::size_t track = indexOf(model.tracks(), Channel::kDelay, kB, kA);
  ASSERT_LT(track, model.tracks().size());
  const LogProbabilities logs = logProbabilities(half.delays(kA, kB));
  double mean = 0;
  double squares = 0;
  for (std::size_t bin = 0; bin < log_bins::kBins; ++bin) {
    const double share = half.delays(kA, kB)[bin] / static_cast<double>(half.total(kA, kB));
    mean -= share * logs[bin];
    squares += share * logs[bin] * logs[bin];
  }
  const double deviation = std::sqrt(squares - mean * mean);
  ASSERT_GT(deviation, 0.5) << "it is taken as it is";
  const std::size_t rare = log_bins::bin(110 * kMillisecond);
  ASSERT_LT((-logs[rare] - mean) / deviation, 6);
  EXPECT_NEAR(model.surprises(track)[rare], (-logs[rare] - mean) / deviation, 1e-9);
  // What is usual, or differs from it by little, does not surprise.
  const std::size_t often = log_bins::bin(20 * kMillisecond);
  EXPECT_NEAR(model.surprises(track)[often], (-logs[often] - mean) / deviation, 1e-9);
  EXPECT_LE(model.surprises(track)[log_bins::bin(40 * kMillisecond)], 0);
}

TEST(EvidenceModel, SurpriseIsBounded) {
  const Model model(watch(pairCounts(1), pairCounts(2)));
  for (const Channel channel : {Channel::kDelay, Channel::kSlowDelay}) {
    const std::size_t track = indexOf(model.tracks(), channel, kB, kA);
    ASSERT_LT(track, model.tracks().size());
    double largest = 0;
    for (std::int64_t delay = 0; delay < 20 * kSecond; delay += kMillisecond) {
      largest = std::max(largest, model.surprises(track)[log_bins::bin(delay)]);
    }
    EXPECT_DOUBLE_EQ(largest, 6);
    EXPECT_LT(model.surprises(track)[log_bins::bin(20 * kMillisecond)], 0);
    EXPECT_GT(model.leastLimit(track), 2 * largest);  // one late event makes two unusual delays
  }
}

TEST(EvidenceModel, SmallEffectsAreNoFault) {
  // B comes 1 ms after A, which comes at random, about every 200 ms.
  const auto start = [](unsigned seed) {
    const Events asked = irregular(kA, 0, 100 * kSecond, 200 * kMillisecond, seed);
    return countsOf({later(together({asked, answers(kB, asked, kMillisecond)}), seed * kStart)},
                    2);
  };
  const Model model(watch(start(1), start(2)));
  const std::size_t track = indexOf(model.tracks(), Channel::kDelay, kB, kA);
  ASSERT_LT(track, model.tracks().size());
  const auto surprise = [&](std::int64_t delay) {
    return model.surprises(track)[log_bins::bin(delay)];
  };
  for (const std::int64_t milliseconds : {0, 1, 3, 5}) {
    EXPECT_LE(surprise(milliseconds * kMillisecond), 0) << milliseconds;
  }
  for (const std::int64_t milliseconds : {30, 60, 100}) {
    EXPECT_GT(surprise(milliseconds * kMillisecond), kLeastSurprise) << milliseconds;
  }
}

// B comes 20 ms after A, which comes at random, about every 200 ms.
Watched withTuning(const Tuning& tuning) {
  const auto start = [](unsigned seed) {
    const Events asked = irregular(kA, 0, 100 * kSecond, 200 * kMillisecond, seed);
    return countsOf(
        {later(together({asked, answers(kB, asked, 20 * kMillisecond)}), seed * kStart)}, 2);
  };
  Watched watched = watch(start(1), start(2));
  watched.tuning = tuning;
  return watched;
}

// Of a time [s], and a share of the period.
Tuning leastEffect(double time, double of_period) {
  Tuning tuning;
  tuning.least_effect = time;
  tuning.least_effect_of_period = of_period;
  return tuning;
}

TEST(EvidenceModel, WhatASmallEffectIsCanBeSaid) {
  // Usual is the bin from 20 to 23.8 ms. Another one is forgiven if all of it is near enough.
  const auto surprise = [](const Tuning& tuning, std::int64_t milliseconds) {
    const Model model(withTuning(tuning));
    const std::size_t track = indexOf(model.tracks(), Channel::kDelay, kB, kA);
    return model.surprises(track).at(log_bins::bin(milliseconds * kMillisecond));
  };
  EXPECT_LE(surprise(leastEffect(0.01, 0), 26), 0);
  EXPECT_GT(surprise(leastEffect(0.002, 0), 26), kLeastSurprise);
  EXPECT_GT(surprise(leastEffect(0.01, 0), 60), kLeastSurprise);
  EXPECT_LE(surprise(leastEffect(0.06, 0), 60), 0);
  // The larger of the two counts; A comes about every 200 ms.
  EXPECT_LE(surprise(leastEffect(0.002, 0.3), 60), 0);
  EXPECT_GT(surprise(leastEffect(0.002, 0.03), 60), kLeastSurprise);
}

TEST(EvidenceModel, ANumberOutOfItsRangeIsRefused) {
  EXPECT_THROW(Model(withTuning(leastEffect(-1e-9, 0.03))), std::invalid_argument);
  EXPECT_THROW(Model(withTuning(leastEffect(0.01, 1))), std::invalid_argument);
  EXPECT_NO_THROW(Model(withTuning(leastEffect(0, 0))));
  const Tuning tuning = leastEffect(0.01, 0.99);
  EXPECT_TRUE(Model(withTuning(tuning)).tuning() == tuning);
}

TEST(EvidenceModel, ADelayNearZeroIsANeighbourOfAPeriod) {
  const auto start = [](unsigned seed) {
    return countsOf({later(together({timer(kA, 0, 100 * kSecond, 100 * kMillisecond),
                                     timer(kB, kMillisecond, 100 * kSecond, 100 * kMillisecond)}),
                           seed * kStart)},
                    2);
  };
  Statistics first = start(1);
  for (unsigned seed = 3; seed < 9; ++seed) {  // with so many starts it is no chance
    first.merge(start(seed));
  }
  const Model model(watch(first, start(2)));
  const std::size_t track = indexOf(model.tracks(), Channel::kDelay, kB, kA);
  ASSERT_LT(track, model.tracks().size());
  EXPECT_LE(model.surprises(track)[log_bins::bin(99 * kMillisecond)], 0);
  EXPECT_GT(model.surprises(track)[log_bins::bin(50 * kMillisecond)], kLeastSurprise);
}

TEST(EvidenceModel, AGapMayDifferByMoreThanAnAnswer) {
  const auto start = [](unsigned seed) {
    return countsOf({later(together({timer(kA, 0, 300 * kSecond, kSecond),
                                     irregular(kB, 0, 300 * kSecond, 50 * kMillisecond, seed)}),
                           seed * kStart)},
                    2);
  };
  const Model model(watch(start(1), start(2)));
  const std::size_t track = indexOf(model.tracks(), Channel::kDelay, kA, kA);
  ASSERT_LT(track, model.tracks().size());
  EXPECT_LE(model.surprises(track)[log_bins::bin(1050 * kMillisecond)], 0);
  EXPECT_LE(model.surprises(track)[log_bins::bin(850 * kMillisecond)], 0);
  EXPECT_GT(model.surprises(track)[log_bins::bin(2 * kSecond)], kLeastSurprise);
  EXPECT_GT(model.surprises(track)[log_bins::bin(400 * kMillisecond)], kLeastSurprise);
}

TEST(EvidenceModel, KnowsTheLongestTimeWithoutAnyEvent) {
  const Model model(watch(countsOf({{{0, kA}, {300, kB}, {400, kA}}}),
                          countsOf({later({{0, kB}, {250, kB}, {600, kA}})})));
  EXPECT_EQ(model.longestSilence(), 350);
  EXPECT_EQ(Model(watch(countsOf({}), kNothing)).longestSilence(), 0);
}

TEST(EvidenceModel, TheTracksStayWhateverProbabilitiesWereLearnedFrom) {
  const Statistics first = pairCounts(1);
  const Statistics second = pairCounts(2);
  const Model both(watch(first, second));
  const Model half(watch(first, second), Model::Learned::kFirst);
  const Model other(watch(first, second), Model::Learned::kSecond);
  ASSERT_EQ(both.tracks().size(), half.tracks().size());
  for (std::size_t track = 0; track < both.tracks().size(); ++track) {
    EXPECT_EQ(both.tracks()[track].channel, half.tracks()[track].channel);
    EXPECT_EQ(both.tracks()[track].to, half.tracks()[track].to);
    EXPECT_EQ(both.tracks()[track].from, half.tracks()[track].from);
  }
  EXPECT_NE(half.overdue(kA, kSecond), other.overdue(kA, kSecond));
  EXPECT_DOUBLE_EQ(half.overdue(kA, kSecond), Model(watch(first, {})).overdue(kA, kSecond));
}

TEST(EvidenceModel, AHalfMayLackAnEventType) {
  Statistics second;  // B alone, so that its id is another one
  second.intern(kTypes[kB]);
  Trainer trainer(second, kWindow);
  for (const Event& event : timer(0, 0, 10 * kSecond, 100 * kMillisecond)) {
    trainer.add(event);
  }
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
  EXPECT_DOUBLE_EQ(model.usualDelay(kA, kA, 1), 0.213);
  EXPECT_DOUBLE_EQ(model.usualDelay(kA, kA, 0.99), 0.213);
  EXPECT_DOUBLE_EQ(model.usualDelay(kA, kA, 0.975), 0.200);
  EXPECT_DOUBLE_EQ(model.meanGap(kA), 200.26 * kMillisecond);
  // The shorter ones are known as exactly as their bin, and never longer than the longest.
  EXPECT_GT(model.usualDelay(kA, kA, 0.01), 0.190);
  EXPECT_LT(model.usualDelay(kA, kA, 0.01), 0.200);
  EXPECT_LT(model.usualDelay(kA, kA, 0.96), 0.213);
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
    EXPECT_NEAR(model.usualDelay(kA, kB, share), 0.020 + 0.0038 * share, 1e-4) << share;
  }
}

TEST(EvidenceModel, UsualDelaysAreThoseThatAShareDidNotExceed) {
  const Model model(watch(pairCounts(1), pairCounts(2)));
  EXPECT_NEAR(model.usualDelay(kA, kB, 0.05), 0.020, 0.004);
  EXPECT_NEAR(model.usualDelay(kA, kB, 0.60), 0.020, 0.004);
  EXPECT_NEAR(model.usualDelay(kA, kB, 0.95), 0.040, 0.008);
}

}  // namespace
}  // namespace self_awareness::core::evidence
