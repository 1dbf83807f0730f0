#include "core/evidence/watch/silent_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "../recordings.h"
#include "../tracks.h"
#include "core/evidence/watch/gain.h"
#include "self_awareness/core/model.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kLength = 60 * kSecond;

// Timers that have nothing to do with each other, each with an answer, and one that is asked
// seldom.
Statistics robot(EventId timers, unsigned seed) {
  std::mt19937 random(seed);
  Events events;
  for (EventId id = 0; id < timers; ++id) {
    const std::int64_t period = (40 + 37 * id % 200) * kMillisecond;
    const Events asked = irregular(2 * id, 0, kLength, period, static_cast<unsigned>(random()));
    events = together({events, asked, answers(2 * id + 1, asked, (2 + id) * kMillisecond)});
  }
  const Events goals = irregular(2 * timers, 0, kLength, 1500 * kMillisecond, seed);
  events = together({events, goals, answers(2 * timers + 1, goals, 400 * kMillisecond)});
  return countsOf({later(events, seed * kStart)}, numberedTypes(2 * timers + 2));
}

Halves robotHalves(EventId timers) {
  return {robot(timers, 1), robot(timers, 2)};
}

Halves without(const Halves& counts, const PairSet& pairs) {
  return {counts[0].without(pairs), counts[1].without(pairs)};
}

std::size_t numberOf(const PairSet& pairs) {
  std::size_t number = 0;
  pairs.forEach([&](EventId /*to*/, EventId /*from*/) { ++number; });
  return number;
}

void expectSame(const Watched& a, const Watched& b) {
  expectSameTracks(a.tracks, b.tracks);
  EXPECT_TRUE(a.halves == b.halves);
}

TEST(SilentPairs, AreMostAndWhatIsWatchedStaysTheSame) {
  const Halves counts = robotHalves(8);
  const PairSet silent = silentPairs(counts, {}, {});
  EXPECT_GT(numberOf(silent), 18 * 17 / 2);
  const Halves rest = without(counts, silent);
  const Watched watched = watch(counts[0], counts[1]);
  EXPECT_TRUE(isWatched(watched.tracks, kPairs, 1, 0));
  EXPECT_TRUE(isWatched(watched.tracks, kDeadlines, 17, 16));
  expectSame(watch(rest[0], rest[1]), watched);
  EXPECT_EQ(rest[0].delaysToAny(), counts[0].delaysToAny());
  EXPECT_EQ(rest[0].total(3, 0), 0U);
  EXPECT_GT(counts[0].total(3, 0), 0U);
}

TEST(SilentPairs, AreNoneOfWhichTooLittleIsKnown) {
  // Of each half, C has 20 events.
  const auto half = [](unsigned seed) {
    return countsOf({together({irregular(kA, 0, kLength, 100 * kMillisecond, seed),
                               irregular(kB, 0, kLength, 150 * kMillisecond, seed + 1),
                               timer(kC, 0, kLength, 3 * kSecond)})});
  };
  const Halves counts{half(1), half(11)};
  const PairSet silent = silentPairs(counts, {}, {});
  EXPECT_TRUE(silent.contains(kA, kB));
  EXPECT_TRUE(silent.contains(kB, kA));
  EXPECT_FALSE(silent.contains(kC, kA)) << "20 delays of a half";
  EXPECT_TRUE(silent.contains(kA, kC)) << "but 39 gaps in all, and many delays";
  Tuning tuning;
  tuning.fewest_gaps = 50;
  EXPECT_FALSE(silentPairs(counts, {}, tuning).contains(kA, kC)) << "who hardly came";
}

TEST(SilentPairs, StayLeftOutOfWhatIsMerged) {
  const Halves counts = robotHalves(4);
  const PairSet silent = silentPairs(counts, {}, {});
  ASSERT_TRUE(silent.contains(3, 0));
  const Statistics rest = counts[0].without(silent);
  for (bool first : {true, false}) {
    Statistics merged = first ? rest : counts[1];
    merged.merge(first ? counts[1] : rest);
    EXPECT_TRUE(merged.leftOut() == silent);
    EXPECT_EQ(merged.total(0, 3), 0U);
    EXPECT_EQ(merged.total(0, 1), counts[0].total(0, 1) + counts[1].total(0, 1));
    Statistics all = counts[0];
    all.merge(counts[1]);
    EXPECT_EQ(merged.delaysToAny(), all.delaysToAny());
    EXPECT_TRUE(merged == all.without(silent));
  }
}

TEST(SilentPairs, AreLeftOutOfModelsOfManyEventTypesOnly) {
  for (const EventId timers : {EventId{4}, EventId{kMostTypesOfAllPairs / 2}}) {
    core::Model model;
    model.evidence = robotHalves(timers);
    const Watched watched = watch(model.evidence[0], model.evidence[1]);
    model.watch();
    EXPECT_EQ(model.evidence[0].leftOut().empty(), timers == 4);
    EXPECT_TRUE(model.evidence[0].leftOut() == model.evidence[1].leftOut());
    expectSame(model.watched, watched);
  }
}

TEST(InformationGain, NeverExceedsTheMostThatItCanBe) {
  const Halves counts = robotHalves(6);
  const double fewest = Tuning{}.fewest_gaps;
  const InformationGain gain(counts[0], counts[1], fewest);
  for (EventId to = 0; to < counts[0].size(); ++to) {
    for (EventId from = 0; from < counts[0].size(); ++from) {
      EXPECT_GE(gain.most(from, to), gain(from, to)) << from << " " << to;
    }
  }
}

constexpr double kFewestDelays = 50;

// So many delays after one event type, by bin.
Partners after(EventId from, const std::map<std::size_t, std::uint32_t>& counts) {
  Partner partner;
  partner.id = from;
  for (const auto& [bin, count] : counts) {
    partner.delays.at(bin) = count;
  }
  return partnersOf({partner});
}

TEST(InformationGain, IsTheMeanLogRatioOnTheOtherHalf) {
  Statistics learned = countsOf({}, 2);
  learned.setPartners(kB, after(kA, {{10, 50}}));
  learned.setPartners(kA, after(kA, {{20, 100}}));
  Statistics measured = countsOf({}, 2);
  measured.setPartners(kB, after(kA, {{10, 30}, {20, 20}}));
  const InformationGain gain(learned, measured, kFewestDelays);
  // P: 50.5 and 0.5 of 75; Q: 50.5 and 100.5 of 175.
  EXPECT_NEAR(gain(kA, kB), std::log(175.0 / 75) + 20 * std::log(0.5 / 100.5) / 50, 1e-12);
  EXPECT_EQ(gain(kA, kA), 0);  // not measured
  EXPECT_EQ(gain(kB, kA), 0);  // not learned
  measured.setPartners(kB, after(kA, {{10, 30}, {20, 19}}));
  EXPECT_EQ(gain(kA, kB), 0);  // too little to measure on
}

}  // namespace
}  // namespace self_awareness::core::evidence
