#include "self_awareness/core/evidence/count/delay_histogram.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/evidence/count/log_bins.h"

namespace self_awareness::core::evidence {
namespace {

constexpr double kMillisecond = 1e6;

DelayHistogram counts() {
  DelayHistogram counts{};
  counts[1] = 10;
  counts[2] = 40;
  return counts;
}

TEST(DelayHistogram, ItsProbabilitiesHaveOneMoreCountInEveryBin) {
  const LogProbabilities logs = counts().logProbabilities();
  EXPECT_DOUBLE_EQ(logs[0], std::log(0.01));
  EXPECT_DOUBLE_EQ(logs[1], std::log(0.11));
  EXPECT_DOUBLE_EQ(logs[2], std::log(0.41));
  SumOfDelays sum{};
  sum[1] = 10;
  sum[2] = 40;
  EXPECT_EQ(logProbabilities(sum), logs);
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

}  // namespace
}  // namespace self_awareness::core::evidence
