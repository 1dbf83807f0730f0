#include "self_awareness/core/paper/delay_statistics.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <vector>

#include "core/paper/delay_trainer.h"
#include "self_awareness/core/stream/clock.h"

namespace self_awareness::core::paper {
namespace {

const EventType kA{"/a", "/x", "T"};
const EventType kB{"/b", "/y", "T"};
const EventType kC{"/c", "/z", "T"};

struct Occurrence {
  std::int64_t stamp;
  EventType type;
};
using Recording = std::vector<Occurrence>;

void train(const Recording& recording, DelayStatistics& statistics) {
  DelayTrainer trainer(statistics);
  for (const Occurrence& occurrence : recording) {
    trainer.add({occurrence.stamp, statistics.intern(occurrence.type)});
  }
}

Recording randomRecording(unsigned seed, const std::vector<EventType>& types) {
  std::mt19937 random(seed);
  Recording recording;
  std::int64_t stamp = 1000000000;
  for (int i = 0; i < 2000; ++i) {
    stamp += static_cast<std::int64_t>(random() % 30000000);
    recording.push_back({stamp, types[random() % types.size()]});
  }
  return recording;
}

TEST(Binning, FloorsToIntegerNanoseconds) {
  const Binning binning{100000000, 0};
  EXPECT_EQ(binning.bin(300000000), 3);  // floor(0.3 / 0.1) is 2 with floating point seconds
  EXPECT_EQ(binning.bin(299999999), 2);
  EXPECT_EQ(binning.bin(0), 0);
  EXPECT_EQ(binning.bin(-1), 0);
}

TEST(Binning, OverflowBinTakesAllBeyondTheHorizon) {
  const Binning binning{10, 10};
  EXPECT_EQ(binning.bin(99), 9);
  EXPECT_EQ(binning.bin(100), 10);
  EXPECT_EQ(binning.bin(100000), 10);
}

TEST(Binning, RefusesImpossibleValues) {
  EXPECT_THROW(DelayStatistics(Binning{0, 0}), std::invalid_argument);
  EXPECT_THROW(DelayStatistics(Binning{-5, 0}), std::invalid_argument);
  EXPECT_THROW(DelayStatistics(Binning{10, -1}), std::invalid_argument);
}

TEST(DelayStatistics, CountsOfTwoTrainingsEqualTrainingOnBoth) {
  const Recording first = randomRecording(1, {kA, kB});
  const Recording second = randomRecording(2, {kC, kB});  // other types in another order
  DelayStatistics both(Binning{10000000, 0});
  train(first, both);
  train(second, both);
  DelayStatistics sum(Binning{10000000, 0});
  DelayStatistics other(Binning{10000000, 0});
  train(first, sum);
  train(second, other);
  EXPECT_FALSE(sum == both);
  sum.merge(other);
  EXPECT_TRUE(sum == both);
}

TEST(DelayStatistics, RefusesToAddWhatWasBinnedDifferently) {
  DelayStatistics fine(Binning{5000000, 0});
  const DelayStatistics coarse(Binning{10000000, 0});
  EXPECT_THROW(fine.merge(coarse), std::invalid_argument);
}

TEST(DelayTrainer, CountsNoDelayAcrossAStepOfTheClock) {
  DelayStatistics statistics(Binning{10000000, 0});
  const std::int64_t later = 10 + kLongestSilence + 1;
  train({{0, kA}, {10, kA}, {later, kA}, {later + 10, kA}, {5, kA}}, statistics);
  const EventId a = *statistics.vocabulary().find(kA);
  EXPECT_EQ(statistics.pair(a, a).total(), 2U);
  EXPECT_EQ(statistics.eventCount(a), 5U);
}

TEST(Vocabulary, RefusesATypeThatOccursTwice) {
  EXPECT_THROW(Vocabulary({kA, kB, kA}), std::invalid_argument);
}

}  // namespace
}  // namespace self_awareness::core::paper
