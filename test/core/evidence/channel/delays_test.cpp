#include "core/evidence/channel/delays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../recordings.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

// More than chance [standard deviations].
constexpr double kLeastSurprise = 3;

DelaySurprise surpriseOf(const Watched& watched, EventId from, EventId to) {
  return DelaySurprise(Model(watched), watched.halves, from, to);
}

// B comes so much after A [ns].
Watched twoStarts(std::int64_t delay) {
  return watch(startOf(followed(1, 100 * kSecond, delay), 1),
               startOf(followed(2, 100 * kSecond, delay), 2));
}

TEST(DelaySurprise, IsStandardisedByWhatTheOtherHalfFinds) {
  // B comes 20 or 40 ms after A, and one in fifty 110 ms.
  const Events asked = irregular(kA, 0, 200 * kSecond, 200 * kMillisecond, 1);
  Events answered = answers(kB, asked, 20 * kMillisecond);
  for (std::size_t k = 0; k < answered.size(); ++k) {
    answered[k].stamp += k % 50 == 7 ? 90 * kMillisecond : k % 3 == 0 ? 20 * kMillisecond : 0;
  }
  const Statistics half = countsOf({together({asked, answered})}, 2);
  const Watched watched = watch(half, half);
  const DelaySurprise surprise(Model(watched, Model::Learned::kFirst), watched.halves, kA, kB);
  const DelayHistogram& delays = half.delays(kA, kB);
  const LogProbabilities logs = delays.logProbabilities();
  double mean = 0;
  double squares = 0;
  for (std::size_t bin = 0; bin < log_bins::kBins; ++bin) {
    const double share = delays[bin] / static_cast<double>(delays.total());
    mean -= share * logs[bin];
    squares += share * logs[bin] * logs[bin];
  }
  const double deviation = std::sqrt(squares - mean * mean);
  ASSERT_GT(deviation, 0.5) << "it is taken as it is";
  const std::size_t rare = log_bins::bin(110 * kMillisecond);
  ASSERT_LT((-logs[rare] - mean) / deviation, 6);
  EXPECT_NEAR(surprise(110 * kMillisecond), (-logs[rare] - mean) / deviation, 1e-9);
  // What is usual, or differs from it by little, does not surprise.
  const std::size_t often = log_bins::bin(20 * kMillisecond);
  EXPECT_NEAR(surprise(20 * kMillisecond), (-logs[often] - mean) / deviation, 1e-9);
  EXPECT_LE(surprise(40 * kMillisecond), 0);
}

TEST(DelaySurprise, IsBounded) {
  const Watched watched = twoStarts(20 * kMillisecond);
  const DelaySurprise surprise = surpriseOf(watched, kA, kB);
  double largest = 0;
  for (std::int64_t delay = 0; delay < 20 * kSecond; delay += kMillisecond) {
    largest = std::max(largest, surprise(delay));
  }
  EXPECT_DOUBLE_EQ(largest, 6);
  EXPECT_LT(surprise(20 * kMillisecond), 0);
  const Model model(watched);
  const std::size_t track = indexOf(model.tracks(), kPairs, kB, kA);
  EXPECT_GT(model.leastLimit(track), 2 * largest) << "one late event makes two unusual delays";
}

TEST(DelaySurprise, SmallEffectsAreNoFault) {
  const DelaySurprise surprise = surpriseOf(twoStarts(kMillisecond), kA, kB);
  for (const std::int64_t milliseconds : {0, 1, 3, 5}) {
    EXPECT_LE(surprise(milliseconds * kMillisecond), 0) << milliseconds;
  }
  for (const std::int64_t milliseconds : {30, 60, 100}) {
    EXPECT_GT(surprise(milliseconds * kMillisecond), kLeastSurprise) << milliseconds;
  }
}

TEST(DelaySurprise, WhatASmallEffectIsCanBeSaid) {
  // Usual is the bin from 20 to 23.8 ms.
  const auto surprise = [](double time, double of_period, std::int64_t milliseconds) {
    Watched watched = twoStarts(20 * kMillisecond);
    watched.tuning.least_effect = time;
    watched.tuning.least_effect_of_period = of_period;
    return surpriseOf(watched, kA, kB)(milliseconds * kMillisecond);
  };
  EXPECT_LE(surprise(0.01, 0, 26), 0);
  EXPECT_GT(surprise(0.002, 0, 26), kLeastSurprise);
  EXPECT_LE(surprise(0.01, 0, 33), 0) << "a part of its bin is near enough";
  EXPECT_GT(surprise(0.01, 0, 60), kLeastSurprise);
  EXPECT_LE(surprise(0.06, 0, 60), 0);
  // The larger of the two counts; A comes about every 200 ms.
  EXPECT_LE(surprise(0.002, 0.3, 60), 0);
  EXPECT_GT(surprise(0.002, 0.03, 60), kLeastSurprise);
}

TEST(DelaySurprise, ADelayNearZeroIsANeighbourOfAPeriod) {
  const Events timers = together({timer(kA, 0, 100 * kSecond, 100 * kMillisecond),
                                  timer(kB, kMillisecond, 100 * kSecond, 100 * kMillisecond)});
  const DelaySurprise surprise = surpriseOf(watch(startOf(timers, 1), startOf(timers, 2)), kA, kB);
  EXPECT_LE(surprise(99 * kMillisecond), 0);
  EXPECT_GT(surprise(50 * kMillisecond), kLeastSurprise);
}

TEST(DelaySum, NeverFallsBelowZeroNorGrowsBeyondItsCap) {
  const DelayNumbers numbers{Tuning{}};
  DelaySum sum;
  EXPECT_DOUBLE_EQ(sum.add(0, 0.5, 1, 0, numbers), -0.5) << "the drift is 1";
  EXPECT_EQ(sum.value, 0);
  EXPECT_DOUBLE_EQ(sum.add(0, 4, 1, 0, numbers), 3);
  EXPECT_DOUBLE_EQ(sum.value, 3);
  EXPECT_DOUBLE_EQ(sum.add(0, 4, 0, 0, numbers), 0) << "it does not count";
  sum.capAt(10, numbers);
  EXPECT_FALSE(sum.isAbnormal(numbers));
  for (int k = 0; k < 10; ++k) {
    sum.add(0, 6, 1, 0, numbers);
  }
  EXPECT_DOUBLE_EQ(sum.value, 15);
  EXPECT_TRUE(sum.isAbnormal(numbers));
}

TEST(DelaySum, WithoutALimitItIsNeverAbnormal) {
  const DelayNumbers numbers{Tuning{}};
  DelaySum sum;
  sum.capAt(std::nan(""), numbers);
  for (int k = 0; k < 1000; ++k) {
    sum.add(0, 6, 1, 0, numbers);
  }
  EXPECT_EQ(sum.value, DelaySum::kMost);
}

TEST(DelaySum, IsRelativeToTheRegimeOfTheLastMinutes) {
  const DelayNumbers numbers{Tuning{}};
  EXPECT_DOUBLE_EQ(numbers.shareOfRegime(12 * kSecond), 0.1);
  EXPECT_EQ(numbers.shareOfRegime(-kSecond), 0);
  EXPECT_EQ(numbers.shareOfRegime(1000 * kSecond), 1);
  DelaySum sum;
  sum.add(0, 4, 1, 0.1, numbers);
  EXPECT_DOUBLE_EQ(sum.regime, 0.4);
  EXPECT_DOUBLE_EQ(sum.add(0, 4, 1, 0, numbers), 2.6);
  sum.regime = -2;
  EXPECT_DOUBLE_EQ(sum.add(0, 4, 1, 0, numbers), 3) << "what is more usual than usual is no debt";
}

/// Delays in words: of so many [s], half of them unusual; the usual one came often before.
std::string wordsOf(const std::vector<double>& unusual, const std::string& other, Kind kind) {
  std::vector<SeenDelay> seen;
  std::int64_t now = 0;
  for (int k = 0; k < 20; ++k) {
    seen.push_back({now += 100 * kMillisecond, 45e6, -1});
  }
  const std::int64_t since = now + 100 * kMillisecond;
  for (const double delay : unusual) {
    seen.push_back({now += 100 * kMillisecond, delay * 1e9, 3});
    seen.push_back({now += 100 * kMillisecond, 45e6, -1});
  }
  Reason reason;
  reason.after = other;
  describeDelays(seen, 100, 30e6, since + 12040 * kMillisecond, reason);
  EXPECT_EQ(reason.unit, unit::kSeconds);
  EXPECT_EQ(reason.kind, kind) << reason.words;
  return reason.words;
}

TEST(DescribeDelays, SaysHowMuchLaterHowOftenAndSinceWhen) {
  EXPECT_EQ(wordsOf({0.0471, 0.0471, 0.0471}, "/a /x T", Kind::kLate),
            "2.1 ms later than usual 3 times of 6 after /a /x T in the last 12.0 s, usually "
            "0.045 s");
  EXPECT_EQ(wordsOf({0.0429, 0.0429}, "/a /x T", Kind::kEarly),
            "2.1 ms earlier than usual 2 times of 4 after /a /x T in the last 12.0 s, usually "
            "0.045 s");
  EXPECT_EQ(wordsOf({0.245}, "/a", Kind::kLate).rfind("200 ms later than usual 1 time of 2 ", 0),
            0U);
  EXPECT_EQ(wordsOf({3.045}, "/a", Kind::kLate).rfind("3.00 s later than usual 1 time of 2 ", 0),
            0U);
}

TEST(DescribeDelays, SomeEarlierAndSomeLaterAreScattered) {
  EXPECT_EQ(
      wordsOf({0.033, 0.057, 0.033, 0.057}, "/a", Kind::kOutOfOrder),
      "12.0 ms earlier or later than usual 4 times of 8 after /a in the last 12.0 s, usually "
      "0.045 s");
}

TEST(DescribeDelays, WithoutAnyItSaysNoNumber) {
  Reason reason;
  reason.after = "/a /x T";
  describeDelays({}, 100, 30e6, kSecond, reason);
  EXPECT_EQ(reason.kind, Kind::kOutOfOrder);
  EXPECT_TRUE(std::isnan(reason.value));
  EXPECT_EQ(reason.words, "at unusual delays after /a /x T");
}

}  // namespace
}  // namespace self_awareness::core::evidence
