#include "core/evidence/count/log_bins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "self_awareness/core/stream/clock.h"

namespace self_awareness::core::evidence {
namespace {

TEST(LogBins, AreFourAnOctaveFrom2500UsTo10240Ms) {
  EXPECT_EQ(log_bins::bin(0), 0U);
  EXPECT_EQ(log_bins::bin(-kNanosecondsPerSecond), 0U);
  EXPECT_EQ(log_bins::bin(2499999), 0U);
  EXPECT_EQ(log_bins::bin(2500000), 1U);
  EXPECT_EQ(log_bins::bin(4999999), 4U);
  EXPECT_EQ(log_bins::bin(5000000), 5U);
  EXPECT_EQ(log_bins::bin(10239999999), log_bins::kBins - 2);
  EXPECT_EQ(log_bins::bin(10240000000), log_bins::kBins - 1);
  EXPECT_EQ(log_bins::bin(kLongestSilence), log_bins::kBins - 1);
}

TEST(LogBins, EveryEdgeBelongsToTheBinAboveIt) {
  EXPECT_EQ(log_bins::lowerEdge(0), 0);
  for (std::size_t bin = 1; bin < log_bins::kBins; ++bin) {
    EXPECT_EQ(log_bins::bin(log_bins::lowerEdge(bin)), bin);
    EXPECT_EQ(log_bins::bin(log_bins::lowerEdge(bin) - 1), bin - 1);
  }
}

TEST(LogBins, AreThoseOfALiteralSearch) {
  std::array<std::int64_t, log_bins::kBins - 1> edges{};
  for (std::size_t k = 0; k < edges.size(); ++k) {
    edges[k] = std::llround(2.5e6 * std::exp2(static_cast<double>(k) / 4));
  }
  std::mt19937_64 random(7);
  for (int i = 0; i < 100000; ++i) {
    const auto delay = static_cast<std::int64_t>(random() >> (14 + random() % 50));
    const auto bin = std::upper_bound(edges.begin(), edges.end(), delay) - edges.begin();
    ASSERT_EQ(log_bins::bin(delay), static_cast<std::size_t>(bin)) << delay;
  }
}

TEST(LogBins, TheMiddleIsTheGeometricMeanOfTheEdges) {
  EXPECT_DOUBLE_EQ(log_bins::middle(0), 1.25e6);
  EXPECT_NEAR(log_bins::middle(1), 2.5e6 * std::exp2(0.125), 1);
  EXPECT_NEAR(log_bins::middle(48), 10.24e9 * std::exp2(-0.125), 1);
  EXPECT_DOUBLE_EQ(log_bins::middle(49), 10.24e9);
}

}  // namespace
}  // namespace self_awareness::core::evidence
