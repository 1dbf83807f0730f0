#include "self_awareness/core/evidence/count/delay_histogram.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/evidence/count/log_bins.h"
#include "self_awareness/core/stream/clock.h"

namespace self_awareness::core::evidence {
namespace {

constexpr double kMillisecond = 1e6;

DelayHistogram counts() {
  DelayHistogram counts{};
  counts[1] = 10;
  counts[2] = 40;
  return counts;
}

TEST(DelayHistogram, ItsProbabilitiesHaveHalfACountMoreInEveryBin) {
  const ByBin found = counts().probabilities();
  EXPECT_DOUBLE_EQ(found[0], 0.5 / 75);
  EXPECT_DOUBLE_EQ(found[1], 10.5 / 75);
  EXPECT_DOUBLE_EQ(found[2], 40.5 / 75);
  SumOfDelays sum{};
  sum[1] = 10;
  sum[2] = 40;
  EXPECT_DOUBLE_EQ(logProbabilities(sum)[2], std::log(40.5 / 75));
  EXPECT_EQ(logProbabilities(sum), logProbabilities(counts()));
}

TEST(DelayHistogram, ItsTotalNeedsMoreBitsThanACount) {
  DelayHistogram many{};
  many[3] = many[4] = 4000000000U;
  EXPECT_EQ(many.total(), 8000000000U);
  EXPECT_EQ(DelayHistogram{}.total(), 0U);
}

TEST(DelayHistogram, AQuantileIsEstimatedWithinItsBin) {
  const auto edge = [](std::size_t bin) { return static_cast<double>(log_bins::lowerEdge(bin)); };
  const double longest = 100 * kMillisecond;
  EXPECT_DOUBLE_EQ(counts().quantile(0.1, longest), (edge(1) + edge(2)) / 2);
  EXPECT_DOUBLE_EQ(counts().quantile(0.2, longest), edge(2));
  EXPECT_DOUBLE_EQ(counts().quantile(0.6, longest), (edge(2) + edge(3)) / 2);
  EXPECT_DOUBLE_EQ(counts().quantile(1, longest), edge(3));
  EXPECT_DOUBLE_EQ(counts().quantile(1, edge(2) + 1), edge(2) + 1) << "none was longer";
  EXPECT_EQ(DelayHistogram{}.quantile(0.5, longest), 0);
}

TEST(DelayHistogram, TheMiddleLeavesOutAsManyOnBothSides) {
  DelayHistogram delays{};
  delays[5] = 4;
  delays[10] = 42;
  delays[11] = 50;
  delays[20] = 4;
  EXPECT_EQ(delays.middle(0.9).first, 10U);
  EXPECT_EQ(delays.middle(0.9).last, 11U);
  EXPECT_EQ(delays.middle(1).first, 5U);
  EXPECT_EQ(delays.middle(1).last, 20U);
}

TEST(LogBins, AreFourAnOctaveFrom2500UsTo10240MsEachWithItsLowerEdge) {
  EXPECT_EQ(log_bins::lowerEdge(0), 0);
  EXPECT_EQ(log_bins::lowerEdge(1), 2500000);
  EXPECT_EQ(log_bins::lowerEdge(5), 5000000);
  EXPECT_EQ(log_bins::lowerEdge(log_bins::kBins - 1), 10240000000);
  for (std::size_t bin = 1; bin < log_bins::kBins; ++bin) {
    EXPECT_EQ(log_bins::bin(log_bins::lowerEdge(bin)), bin);
    EXPECT_EQ(log_bins::bin(log_bins::lowerEdge(bin) - 1), bin - 1);
  }
  EXPECT_EQ(log_bins::bin(-kNanosecondsPerSecond), 0U);
  EXPECT_EQ(log_bins::bin(kLongestSilence), log_bins::kBins - 1);
}

TEST(LogBins, TheMiddleIsTheGeometricMeanOfTheEdges) {
  EXPECT_DOUBLE_EQ(log_bins::middle(0), 1.25e6);
  EXPECT_NEAR(log_bins::middle(1), 2.5e6 * std::exp2(0.125), 1);
  EXPECT_NEAR(log_bins::middle(48), 10.24e9 * std::exp2(-0.125), 1);
  EXPECT_DOUBLE_EQ(log_bins::middle(49), 10.24e9);
}

}  // namespace
}  // namespace self_awareness::core::evidence
