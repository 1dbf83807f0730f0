#include "self_awareness/core/evidence/block_maxima.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "self_awareness/core/evidence/limits.h"

namespace self_awareness::core::evidence {
namespace {

using Values = std::vector<double>;

BlockMaxima maximaOf(const Values& values) {
  BlockMaxima maxima;
  for (const double value : values) {
    maxima.add(value);
  }
  return maxima;
}

Values gumbel(double location, double scale, std::size_t number, unsigned seed) {
  std::mt19937 random(seed);
  std::extreme_value_distribution<double> distribution(location, scale);
  Values values(number);
  std::generate(values.begin(), values.end(), [&] { return std::max(distribution(random), 0.0); });
  return values;
}

// Rounds to the nearest of 256 values between two powers of two.
double nearest(double value) {
  const double step = std::exp2(std::floor(std::log2(value)) - 8);
  return value < 1.0 / 1024 ? 0 : std::floor(value / step + 0.5) * step;
}

// L-moments of single values in the order of their size (Hosking 1990).
double literalLimit(Values values, double probability) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double b0 = 0;
  double b1 = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    b0 += values[i] / n;
    b1 += static_cast<double>(i) / (n - 1) * values[i] / n;
  }
  const double scale = (2 * b1 - b0) / std::log(2.0);
  return b0 - 0.57721566490153286 * scale - scale * std::log(-std::log1p(-probability));
}

std::vector<std::pair<float, std::uint32_t>> contents(const BlockMaxima& maxima) {
  std::vector<std::pair<float, std::uint32_t>> pairs;
  for (const auto& [maximum, count] : maxima.cells()) {
    pairs.emplace_back(maximum, count);
  }
  return pairs;
}

TEST(BlockMaxima, AreRoundedToTheNearest) {
  for (const double exact : {0.0, 1.0 / 1024, 1.0, 3.0, 1.00390625, 200.0, 1048576.0}) {
    EXPECT_EQ(maximaOf({exact}).largest(), exact);
  }
  EXPECT_EQ(maximaOf({1.0019}).largest(), 1);
  EXPECT_EQ(maximaOf({1.0020}).largest(), 1.00390625);
  EXPECT_EQ(maximaOf({1.9999}).largest(), 2);
  EXPECT_EQ(maximaOf({127.9}).largest(), 128);
  EXPECT_EQ(maximaOf({128.2}).largest(), 128);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-10, 20);
  for (int k = 0; k < 10000; ++k) {
    const double value = std::exp2(exponent(random));
    EXPECT_NEAR(maximaOf({value}).largest(), value, 0.002 * value);
    EXPECT_EQ(maximaOf({value}).largest(), nearest(value)) << value;
  }
}

TEST(BlockMaxima, AreZeroIfTinyAndNeverMoreThanTheMost) {
  EXPECT_EQ(contents(maximaOf({0, 1e-300, 0.00097})), (decltype(contents({})){{0, 3}}));
  EXPECT_EQ(contents(maximaOf({1e300, 2e6, 1048575.9, HUGE_VAL})),
            (decltype(contents({})){{1048576, 4}}));
}

TEST(BlockMaxima, AreInOrderEachOnceWithItsCount) {
  BlockMaxima maxima = maximaOf({3, 1, 3.001, 2, 1});
  maxima.add(2, 5);
  EXPECT_EQ(contents(maxima), (decltype(contents({})){{1, 2}, {2, 6}, {3, 2}}));
  EXPECT_EQ(maxima.number(), 10U);
  EXPECT_EQ(maxima.largest(), 3);
  EXPECT_EQ(BlockMaxima().number(), 0U);
  EXPECT_EQ(BlockMaxima().largest(), 0);
}

TEST(BlockMaxima, OfPartsAddUpInAnyOrder) {
  const Values values = gumbel(5, 2, 3000, 1);
  const auto whole = contents(maximaOf(values));
  std::vector<BlockMaxima> parts(7);
  for (std::size_t k = 0; k < values.size(); ++k) {
    parts[k * k % parts.size()].add(values[k]);  // parts of different sizes, some empty
  }
  std::mt19937 random(2);
  for (int k = 0; k < 10; ++k) {
    std::shuffle(parts.begin(), parts.end(), random);
    BlockMaxima sum;
    for (const BlockMaxima& part : parts) {
      sum.merge(part);
    }
    EXPECT_EQ(contents(sum), whole);
    EXPECT_EQ(sum.number(), values.size());
  }
}

TEST(BlockMaxima, DoNotGrowWithTheNumberOfBlocks) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-20, std::log2(200));
  BlockMaxima evidence;
  for (int k = 0; k < 1000000; ++k) {
    evidence.add(std::exp2(exponent(random)));
  }
  EXPECT_EQ(evidence.number(), 1000000U);
  EXPECT_EQ(evidence.cells().size(), 4498U);
  exponent = std::uniform_real_distribution<double>(-20, 30);
  for (int k = 0; k < 1000000; ++k) {
    evidence.add(std::exp2(exponent(random)));
  }
  EXPECT_EQ(evidence.cells().size(), 7682U);
  EXPECT_LE(evidence.cells().capacity() * sizeof(BlockMaxima::Cell), 2U * 7682 * 8);
}

TEST(BlockMaxima, HaveTheLMomentsOfTheRoundedValues) {
  for (const std::size_t number : {2, 5, 100, 20000}) {
    const Values values = gumbel(1, 0.5, number, 4);
    Values rounded(values.size());
    std::transform(values.begin(), values.end(), rounded.begin(), nearest);
    for (const double probability : {0.5, 0.01, 1e-6}) {
      const double expected = literalLimit(rounded, probability);
      EXPECT_NEAR(gumbelLimit(maximaOf(values), probability), expected, 1e-9 * expected);
    }
  }
}

TEST(BlockMaxima, HaveNearlyTheLimitOfTheExactValues) {
  unsigned seed = 10;
  for (const double location : {0.5, 5.0, 50.0}) {
    for (const double scale : {0.02, 0.1, 0.5}) {
      for (const std::size_t number : {50, 1000, 20000}) {
        const Values values = gumbel(location, scale * location, number, seed++);
        for (const double probability : {0.1, 1e-3, 1e-6}) {
          const double exact = literalLimit(values, probability);
          EXPECT_NEAR(gumbelLimit(maximaOf(values), probability), exact, 0.005 * exact)
              << location << ' ' << scale << ' ' << number << ' ' << probability;
        }
      }
    }
  }
}

TEST(BlockMaxima, ThatHardlyVaryHaveALimitFarBelowTheMargin) {
  Values values;
  for (int k = 0; k < 1000; ++k) {
    values.push_back(1 + 1.0 / 512 + (k % 2 == 0 ? 1e-6 : -1e-6));  // one up, one down
  }
  const double exact = literalLimit(values, 1e-6);
  EXPECT_NEAR(exact, values.front(), 1e-4);
  const double found = gumbelLimit(maximaOf(values), 1e-6);
  EXPECT_GT(found, 1.01 * exact);
  EXPECT_LT(found, 1.02 * exact);
}

}  // namespace
}  // namespace self_awareness::core::evidence
