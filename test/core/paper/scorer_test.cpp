// Compares the scorer with equations 3 and 4, written down literally.

#include "core/paper/scorer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/paper/delay_trainer.h"
#include "self_awareness/core/paper/delay_statistics.h"
#include "self_awareness/core/paper/model.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core::paper {
namespace {

class LiteralScorer {
 public:
  explicit LiteralScorer(const DelayStatistics& statistics)
      : statistics_(statistics), last_seen_(statistics.vocabulary().size()) {}

  double score(const Event& event) {
    const std::size_t types = last_seen_.size();
    double entropy_sum = 0;
    for (EventId from = 0; from < types; ++from) {
      entropy_sum += last_seen_[from] ? statistics_.pair(from, event.id).entropyBits() : 0;
    }
    double score = 0;
    for (EventId from = 0; from < types; ++from) {
      const Histogram& histogram = statistics_.pair(from, event.id);
      if (last_seen_[from] && !histogram.empty()) {
        const std::int64_t bin = statistics_.binning().bin(event.stamp - *last_seen_[from]);
        const double probability =
            static_cast<double>(histogram.count(bin)) / static_cast<double>(histogram.total());
        score += probability * (entropy_sum > 0 ? 1 - histogram.entropyBits() / entropy_sum : 1);
      }
    }
    last_seen_[event.id] = event.stamp;
    return score;
  }

 private:
  const DelayStatistics& statistics_;
  std::vector<std::optional<std::int64_t>> last_seen_;
};

// Events at random times, some of them late; the types from `always` on are rare.
std::vector<Event> randomEvents(unsigned seed, std::size_t types, std::size_t always, int events,
                                std::int64_t mean_gap) {
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> gap(1 / static_cast<double>(mean_gap));
  std::vector<Event> recording;
  std::int64_t stamp = 1000000000;
  for (int i = 0; i < events; ++i) {
    stamp += static_cast<std::int64_t>(gap(random));
    const std::int64_t late = random() % 50 == 0 ? mean_gap : 0;
    const std::size_t choices = random() % 100 == 0 ? types : always;
    recording.push_back({stamp - late, static_cast<EventId>(random() % choices)});
  }
  return recording;
}

DelayStatistics train(const Binning& binning, std::size_t types,
                      const std::vector<Event>& events) {
  DelayStatistics statistics(binning);
  for (std::size_t id = 0; id < types; ++id) {
    statistics.intern({"", "/topic_" + std::to_string(id), "T"});
  }
  DelayTrainer trainer(statistics);
  for (const Event& event : events) {
    trainer.add(event);
  }
  return statistics;
}

void expectLiteralScores(const DelayStatistics& statistics, const std::vector<Event>& events) {
  Scorer scorer(std::make_shared<const Model>(statistics));
  LiteralScorer literal(statistics);
  double largest = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const double expected = literal.score(events[i]);
    ASSERT_NEAR(scorer.score(events[i]).score, expected, 1e-13) << i;
    largest = std::max(largest, expected);
  }
  EXPECT_GT(largest, 0.01);
}

TEST(PaperScorer, ScoresLiterallyForAnyNumberOfTypes) {
  for (const std::size_t types : {2, 3, 4, 5, 63, 64, 65, 130}) {
    SCOPED_TRACE(types);
    const std::size_t always = (types + 1) / 2;
    const DelayStatistics statistics =
        train(Binning{10000000, 0}, types, randomEvents(1, types, always, 3000, 5000000));
    expectLiteralScores(statistics, randomEvents(2, types, always, 500, 5000000));
    // Only two types: most are never seen.
    expectLiteralScores(statistics, randomEvents(3, std::min<std::size_t>(types, 2),
                                                 std::min<std::size_t>(types, 2), 300, 5000000));
  }
}

TEST(PaperScorer, ScoresLiterallyWhereBinsOrCountsNeed33Bits) {
  const std::vector<Event> training = randomEvents(1, 3, 2, 500, 2000000000);
  const DelayStatistics bins = train(Binning{1, 0}, 3, training);
  EXPECT_GT(bins.pair(2, 0).quantile(1), std::int64_t{1} << 32);
  expectLiteralScores(bins, training);
  DelayStatistics counts = train(Binning{10000000, 0}, 3, randomEvents(1, 3, 3, 500, 5000000));
  counts.pair(0, 1).add(2, std::uint64_t{1} << 33);
  counts.pair(1, 1).add(1, (std::uint64_t{1} << 31) + 1);
  expectLiteralScores(counts, randomEvents(2, 3, 3, 500, 5000000));
}

TEST(PaperModel, KnowsWhatAnEventScoresOnTheAverage) {
  const DelayStatistics statistics =
      train(Binning{10000000, 0}, 20, randomEvents(1, 20, 15, 3000, 200000000));
  const Model model(statistics);
  for (EventId to = 0; to < model.size(); ++to) {
    double expected = 0;
    for (EventId from = 0; from < model.size(); ++from) {
      const Histogram& histogram = statistics.pair(from, to);
      for (const Histogram::Entry& entry : histogram.entries()) {
        const double p = static_cast<double>(entry.count) / static_cast<double>(histogram.total());
        expected += model.weight(from, to) * p * p;
        EXPECT_NEAR(model.probability(from, to, entry.bin * 10000000), p, 1e-15);
      }
      EXPECT_EQ(model.entropy(from, to), histogram.entropyBits());
    }
    EXPECT_NEAR(model.expectedScore(to), expected, 1e-12);
  }
}

constexpr std::int64_t kMillisecond = 1000000;
constexpr std::int64_t kSecond = 1000 * kMillisecond;

TEST(PaperModel, ATypeWithFewGapsHasNoOpinion) {
  DelayStatistics statistics(Binning{10 * kMillisecond, 0});
  const EventId rare = statistics.intern({"/player", "/scan", "sensor_msgs/LaserScan"});
  const EventId common = statistics.intern({"/slam", "/pose", "geometry_msgs/PoseStamped"});
  DelayTrainer trainer(statistics);
  for (std::uint64_t i = 0; i <= kFewestGaps; ++i) {
    trainer.add({static_cast<std::int64_t>(i) * kSecond, common});
    if (i < kFewestGaps) {
      trainer.add({static_cast<std::int64_t>(i) * kSecond, rare});
    }
  }
  const Model model(statistics);
  EXPECT_EQ(model.logSurvival(rare, 3600 * kSecond), 0);
  // The tail adds one virtual gap to 30 of 1 s: 1.01 s is the upper edge of the longest gap's bin.
  EXPECT_NEAR(model.logSurvival(common, 2 * kSecond), -2 / 1.01 - std::log(31), 1e-12);
  EXPECT_NEAR(model.logSurvival(common, kSecond),
              std::log(30 + std::exp(-1 / 1.01)) - std::log(31), 1e-12);
}

}  // namespace
}  // namespace self_awareness::core::paper
