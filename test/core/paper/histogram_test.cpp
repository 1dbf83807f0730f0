#include "self_awareness/core/paper/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/paper/delay_bins.h"
#include "core/paper/delay_trainer.h"
#include "self_awareness/core/paper/delay_statistics.h"
#include "self_awareness/core/stream/clock.h"

namespace self_awareness::core::paper {
namespace {

using Counts = std::map<std::int64_t, std::uint64_t>;

constexpr std::int64_t kTwoTo32 = std::int64_t{1} << 32;

Histogram histogramOf(const std::vector<std::int64_t>& bins) {
  Histogram histogram;
  for (const std::int64_t bin : bins) {
    histogram.add(bin);
  }
  return histogram;
}

void expectCounts(const Histogram& histogram, const Counts& expected) {
  Counts counts;
  std::uint64_t total = 0;
  std::int64_t previous = -1;
  for (const Histogram::Entry& entry : histogram.entries()) {
    EXPECT_GT(entry.bin, previous);
    previous = entry.bin;
    counts[entry.bin] = entry.count;
    total += entry.count;
    EXPECT_EQ(histogram.count(entry.bin), entry.count);
  }
  EXPECT_EQ(counts, expected);
  EXPECT_EQ(histogram.total(), total);
  EXPECT_EQ(histogram.empty(), expected.empty());
}

// Bins of well filled runs, scattered bins, or both.
std::vector<std::int64_t> randomBins(unsigned seed) {
  std::mt19937_64 random(seed);
  const std::int64_t stretch = 1 + static_cast<std::int64_t>(random() % 300);
  const std::int64_t start = static_cast<std::int64_t>(random() % 1000);
  const std::uint64_t scattered = random() % 5;  // of 4
  std::vector<std::int64_t> bins(random() % 3000);
  for (std::int64_t& bin : bins) {
    bin = random() % 4 < scattered ? static_cast<std::int64_t>(random() % 100000)
                                   : start + static_cast<std::int64_t>(random()) % stretch;
    bin = std::max<std::int64_t>(bin, 0);
  }
  return bins;
}

TEST(Histogram, CountsLikeAMapInAnyOrder) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Counts expected;
    std::vector<std::int64_t> bins = randomBins(seed);
    for (const std::int64_t bin : bins) {
      ++expected[bin];
    }
    const Histogram histogram = histogramOf(bins);
    Histogram copy = histogram;
    const Histogram moved = std::move(copy);
    expectCounts(moved, expected);
    expectCounts(histogram, expected);
    EXPECT_EQ(histogram.count(200000), 0U);
    for (const bool sorted : {false, true}) {
      sorted ? std::sort(bins.begin(), bins.end()) : std::reverse(bins.begin(), bins.end());
      EXPECT_TRUE(histogram == histogramOf(bins));
      EXPECT_EQ(histogram.entropyBits(), histogramOf(bins).entropyBits());  // to the last bit
    }
    bins.push_back(bins.empty() ? 7 : bins.front());
    EXPECT_FALSE(histogram == histogramOf(bins));
  }
}

TEST(Histogram, CountsAndBinsMayNeedMoreThan32Bits) {
  Histogram histogram;
  for (const std::int64_t bin : {3, 1000000}) {  // in the array, and outside of it
    histogram.add(bin, kTwoTo32 - 2);
    histogram.add(bin);
    histogram.add(bin);
    histogram.add(bin);
    histogram.add(bin, 5 * kTwoTo32);
  }
  const auto count = static_cast<std::uint64_t>(6 * kTwoTo32 + 1);
  expectCounts(histogram, {{3, count}, {1000000, count}});
  EXPECT_EQ(histogram.entropyBits(), 1);
  const std::int64_t largest = std::numeric_limits<std::int64_t>::max();
  expectCounts(histogramOf({5, kTwoTo32 + 5, kTwoTo32 - 1, kTwoTo32, largest, kTwoTo32 + 5}),
               {{5, 1}, {kTwoTo32 - 1, 1}, {kTwoTo32, 1}, {kTwoTo32 + 5, 2}, {largest, 1}});
}

TEST(DelayBins, AreThoseOfTheBinning) {
  std::mt19937_64 random(1);
  for (const std::int64_t size : {std::int64_t{1}, std::int64_t{3}, std::int64_t{10000000},
                                  std::int64_t{1} << 24, 2 * kTwoTo32 + 1}) {
    for (const std::int64_t horizon : {std::int64_t{0}, std::int64_t{20}}) {
      const Binning binning{size, horizon};
      const DelayBins bins(binning);
      for (int i = 0; i < 10000; ++i) {
        const std::int64_t from =
            static_cast<std::int64_t>(random() >> 2) - (i % 2 == 0 ? 0 : std::int64_t{1} << 61);
        const std::int64_t delay = static_cast<std::int64_t>(random() >> (4 + i % 60));
        const std::int64_t rounded = delay / size * size;  // on an edge
        ASSERT_EQ(bins.bin(bins.mark(from), bins.mark(from + delay)), binning.bin(delay));
        ASSERT_EQ(bins.bin(bins.mark(from), bins.mark(from + rounded)), binning.bin(rounded));
        ASSERT_EQ(bins.bin(bins.mark(from + delay), bins.mark(from)), 0) << "late";
      }
    }
  }
}

// Delays since an event that comes only once make such bins. If every bin caused a rebuild, it
// would take hours.
TEST(Histogram, GrowsBinByBinInNoTime) {
  constexpr std::int64_t kNumber = 1000000;
  Histogram histogram;
  for (std::int64_t bin = 0; bin < kNumber; ++bin) {
    histogram.add(bin);
  }
  EXPECT_EQ(histogram.total(), static_cast<std::uint64_t>(kNumber));
  Histogram other;
  for (std::int64_t bin = kNumber / 2; bin < 2 * kNumber; ++bin) {
    other.add(bin, 2);
  }
  histogram.merge(other);
  EXPECT_EQ(histogram.count(0), 1U);
  EXPECT_EQ(histogram.count(kNumber - 1), 3U);
  EXPECT_EQ(histogram.count(kNumber), 2U);
  EXPECT_EQ(histogram.entries().size(), 2U * kNumber);
}

const EventType kA{"/a", "/x", "T"};
const EventType kB{"/b", "/y", "T"};
const EventType kC{"/c", "/z", "T"};

// Counts of recordings of random events, each with a seed, and of these types.
using Recordings = std::vector<std::pair<unsigned, std::vector<EventType>>>;

DelayStatistics trained(const Recordings& recordings) {
  DelayStatistics statistics(Binning{10000000, 0});
  for (const auto& [seed, types] : recordings) {
    std::mt19937 random(seed);
    DelayTrainer trainer(statistics);
    std::int64_t stamp = 1000000000;
    for (int i = 0; i < 2000; ++i) {
      stamp += static_cast<std::int64_t>(random() % 30000000);
      trainer.add({stamp, statistics.intern(types[random() % types.size()])});
    }
  }
  return statistics;
}

TEST(Binning, RefusesImpossibleValues) {
  EXPECT_THROW(DelayStatistics(Binning{0, 0}), std::invalid_argument);
  EXPECT_THROW(DelayStatistics(Binning{-5, 0}), std::invalid_argument);
  EXPECT_THROW(DelayStatistics(Binning{10, -1}), std::invalid_argument);
  DelayStatistics fine(Binning{5000000, 0});
  EXPECT_THROW(fine.merge(DelayStatistics(Binning{10000000, 0})), std::invalid_argument);
  EXPECT_THROW(Vocabulary({kA, kB, kA}), std::invalid_argument) << "a type that occurs twice";
}

TEST(DelayStatistics, CountsOfTwoTrainingsEqualTrainingOnBoth) {
  const Recordings second{{2, {kC, kB}}};  // other types in another order
  DelayStatistics sum = trained({{1, {kA, kB}}});
  const DelayStatistics both = trained({{1, {kA, kB}}, second.front()});
  EXPECT_FALSE(sum == both);
  sum.merge(trained(second));
  EXPECT_TRUE(sum == both);
}

}  // namespace
}  // namespace self_awareness::core::paper
