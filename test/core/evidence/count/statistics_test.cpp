#include "self_awareness/core/evidence/count/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

#include "../recordings.h"
#include "core/evidence/count/log_bins.h"
#include "self_awareness/core/stream/clock.h"
#include "self_awareness/core/stream/mode.h"

namespace self_awareness::core::evidence {
namespace {

Events inMilliseconds(std::initializer_list<Event> events) {
  Events scaled;
  for (const Event& event : events) {
    scaled.push_back({event.stamp * kMillisecond, event.id});
  }
  return scaled;
}

Events randomEvents(unsigned seed, EventId first, EventId last) {
  std::mt19937 random(seed);
  Events events;
  std::int64_t stamp = kSecond;
  for (int i = 0; i < 2000; ++i) {
    stamp += static_cast<std::int64_t>(random() % 30000000);
    events.push_back({stamp, static_cast<EventId>(first + random() % (last - first + 1))});
  }
  return events;
}

// The same counts, with the ids of kTypes.
Statistics reordered(const Statistics& counts) {
  Statistics ordered = countsOf({});
  ordered.merge(counts);
  return ordered;
}

TEST(EvidenceTrainer, CountsDelaysGapsAndAnswers) {
  const Statistics counts = countsOf(
      {inMilliseconds({{0, kA}, {10, kB}, {100, kA}, {130, kB}, {150, kB}, {300, kA}, {390, kA}})},
      2);
  EXPECT_EQ(counts.type(kA).events, 4U);
  EXPECT_EQ(counts.type(kA).gaps, 3U);
  EXPECT_EQ(counts.type(kA).gap_sum, 390 * kMillisecond);
  EXPECT_EQ(
      counts.type(kA).longest_gaps,
      (std::vector<std::int64_t>{200 * kMillisecond, 100 * kMillisecond, 90 * kMillisecond}));
  EXPECT_EQ(counts.duration(), 390 * kMillisecond);

  const auto in = [&](EventId from, EventId to, std::int64_t milliseconds) {
    return counts.delays(from, to).at(log_bins::bin(milliseconds * kMillisecond));
  };
  EXPECT_EQ(counts.total(kA, kB), 3U);
  EXPECT_EQ(in(kA, kB, 10), 1U);
  EXPECT_EQ(in(kA, kB, 30), 1U);
  EXPECT_EQ(in(kA, kB, 50), 1U);  // also the second B after the same A
  EXPECT_EQ(counts.total(kB, kA), 3U);
  EXPECT_EQ(in(kB, kA, 90), 1U);
  EXPECT_EQ(in(kB, kA, 150), 1U);
  EXPECT_EQ(in(kB, kA, 240), 1U);
  EXPECT_EQ(counts.answers(kA, kB), 2U);  // none between the last two A
  EXPECT_EQ(counts.answers(kA, kA), 0U);
  EXPECT_EQ(counts.answers(kB, kA), 1U);  // between the first two B, none between the last two
}

TEST(EvidenceTrainer, CountsRatesInFullSpansOnly) {
  Statistics counts;
  counts.intern(kTypes[kA]);
  Trainer trainer(counts, kSecond);
  const auto add = [&](std::int64_t milliseconds, EventId id) {
    trainer.add({milliseconds * kMillisecond, id});
  };
  for (const std::int64_t milliseconds : {500, 1500, 1600, 2200}) {
    add(milliseconds, kA);
  }
  counts.intern(kTypes[kB]);  // first seen when A has long been counted
  add(2500, kB);
  add(4100, kA);
  // 1, 2, 1, 0 A in the closed windows: 3, 3, 1 in two of them.
  EXPECT_EQ(counts.rateWindows(), 3U);
  EXPECT_EQ(counts.type(kA).rate_sum, 7U);
  EXPECT_EQ(counts.type(kA).rate_squares, 19U);
  EXPECT_EQ(counts.type(kB).rate_sum, 2U);
  EXPECT_EQ(counts.type(kB).rate_squares, 2U);
}

TEST(EvidenceTrainer, ALateEventHasNoNegativeDelay) {
  const Statistics counts =
      countsOf({inMilliseconds({{0, kA}, {100, kA}, {50, kA}, {80, kB}})}, 2);
  EXPECT_EQ(counts.type(kA).gap_sum, 100 * kMillisecond);
  EXPECT_EQ(counts.type(kA).longest_gaps.back(), 0);
  EXPECT_EQ(counts.delays(kA, kA).front(), 1U);
  EXPECT_EQ(counts.duration(), 100 * kMillisecond);
}

TEST(EvidenceTrainer, OnlyTheEventBeforeTellsAStepOfTheClock) {
  // Two late events: each is late compared with the one before it, and no step (clock.h).
  const Statistics counts =
      countsOf({inMilliseconds({{1000, kA}, {1160, kA}, {1100, kA}, {1040, kA}, {1200, kA}})}, 1);
  EXPECT_EQ(counts.type(kA).gaps, 4U);
  EXPECT_EQ(counts.type(kA).gap_sum, 320 * kMillisecond);
  EXPECT_EQ(counts.duration(), 200 * kMillisecond);
}

TEST(EvidenceTrainer, NothingCrossesFromOneRecordingIntoTheNext) {
  const Events first = timer(kA, 0, 1500 * kMillisecond, 100 * kMillisecond);
  const Events second = timer(kB, 1500 * kMillisecond, 3000 * kMillisecond, 100 * kMillisecond);
  const Statistics counts = countsOf({first, second}, 2);
  EXPECT_EQ(counts.total(kA, kB), 0U);
  EXPECT_EQ(counts.rateWindows(), 0U);  // neither has 2 s of windows
  EXPECT_EQ(counts.duration(), 2800 * kMillisecond);
  const Events joined = together({first, second});
  EXPECT_EQ(countsOf({joined}, 2).total(kA, kB), 15U);
  EXPECT_GT(countsOf({joined}, 2).rateWindows(), 0U);
}

TEST(EvidenceTrainer, AStepOfTheClockStartsAnotherRecording) {
  for (const std::int64_t later : {10 * kSecond + kLongestSilence + 1, -kSecond}) {
    const Events before = timer(kA, 0, 10 * kSecond, 100 * kMillisecond);
    const Events after = timer(kB, later, later + 10 * kSecond, 100 * kMillisecond);
    Events stepped = before;
    stepped.insert(stepped.end(), after.begin(), after.end());
    EXPECT_TRUE(countsOf({stepped}, 2) == countsOf({before, after}, 2)) << later;
  }
}

TEST(EvidenceTrainer, SaysWhatEveryRecordingShowed) {
  const Statistics counts =
      countsOf({inMilliseconds({{5000, kB}, {5400, kB}, {5500, kA}}),
                inMilliseconds({{1000, kA}, {1100, kB}, {1150, kA}, {1900, kA}})});
  ASSERT_EQ(counts.recordings().size(), 2U);
  const Statistics::Recording& first = counts.recordings()[0];  // in the order of their start
  EXPECT_EQ(first.start, kSecond);
  EXPECT_EQ(first.end, 1900 * kMillisecond);
  EXPECT_EQ(first.longest_silence, 750 * kMillisecond);
  EXPECT_EQ(first.events, (std::vector<std::uint64_t>{3, 1}));
  EXPECT_EQ(first.longest_gaps, (std::vector<std::int64_t>{750 * kMillisecond, 0}));
  const Statistics::Recording& second = counts.recordings()[1];
  EXPECT_EQ(second.start, 5 * kSecond);
  EXPECT_EQ(second.longest_silence, 400 * kMillisecond);
  EXPECT_EQ(second.events, (std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(second.longest_gaps, (std::vector<std::int64_t>{0, 400 * kMillisecond}));
}

TEST(EvidenceTrainer, WhatARecordingCutsOffIsNoGap) {
  const Statistics counts =
      countsOf({together({timer(kA, 0, 60 * kSecond, kSecond), timer(kB, 0, 30 * kSecond, kSecond),
                          timer(kC, 20 * kSecond, 60 * kSecond, kSecond)})});
  EXPECT_EQ(counts.recordings()[0].longest_gaps,
            (std::vector<std::int64_t>{kSecond, kSecond, kSecond}));
}

// The same recording with a stall of the machine: all that came later comes later.
class StalledRecording : public testing::Test {
 protected:
  StalledRecording() {
    Statistics quiet = countsOf({}, 2);
    Statistics stalled = countsOf({}, 2);
    Trainer usual(quiet, kWindow);
    Trainer trainer(stalled, kWindow);
    const Events events = together({timer(kA, 0, 60 * kSecond, 100 * kMillisecond),
                                    timer(kB, 30 * kMillisecond, 60 * kSecond, kSecond)});
    const auto next = std::find_if(events.begin(), events.end(),
                                   [](const Event& event) { return event.stamp >= kAt; });
    trainer.startRecording(
        {std::nullopt, 0, "", {{static_cast<std::size_t>(next - events.begin()), 0, kLength}}});
    for (const Event& event : events) {
      usual.add(event);
      trainer.add({event.stamp + (event.stamp < kAt ? 0 : kLength), event.id});
    }
    usual.finish();
    trainer.finish();
    quiet_ = quiet;
    stalled_ = stalled;
  }
  static constexpr std::int64_t kAt = 30 * kSecond;
  static constexpr std::int64_t kLength = 1300 * kMillisecond;
  Statistics quiet_;
  Statistics stalled_;
};

TEST_F(StalledRecording, NoDelayAndNoGapHasThatTime) {
  for (const EventId id : {kA, kB}) {
    EXPECT_EQ(stalled_.type(id).longest_gaps, quiet_.type(id).longest_gaps);
    EXPECT_EQ(stalled_.type(id).gap_sum, quiet_.type(id).gap_sum);
    EXPECT_EQ(stalled_.delays(kA, id), quiet_.delays(kA, id));
    EXPECT_EQ(stalled_.delays(kB, id), quiet_.delays(kB, id));
  }
}

TEST_F(StalledRecording, SaysHowLongItStoodStill) {
  const Statistics::Recording& recording = stalled_.recordings().at(0);
  EXPECT_EQ(recording.longest_stall, kLength);
  EXPECT_EQ(recording.longest_silence, quiet_.recordings()[0].longest_silence);
  EXPECT_EQ(recording.longest_gaps, quiet_.recordings()[0].longest_gaps);
  EXPECT_EQ(recording.end, quiet_.recordings()[0].end + kLength);
  EXPECT_EQ(stalled_.duration(), quiet_.duration() + kLength);
  EXPECT_EQ(quiet_.recordings()[0].longest_stall, 0);
}

TEST_F(StalledRecording, HasNoRatesUntilWhatWaitedHasCome) {
  const auto without = static_cast<std::uint64_t>((kLength + kRateSpan) / kWindow);
  EXPECT_EQ(stalled_.rateWindows(), quiet_.rateWindows() - without + 1);
}

TEST(EvidenceTrainer, TheLastRecordingCountsOnceItHasEnded) {
  Statistics counts = countsOf({}, 1);
  Trainer trainer(counts, kWindow);
  trainer.add({0, kA});
  EXPECT_TRUE(counts.recordings().empty());
  trainer.finish();
  EXPECT_EQ(counts.recordings().size(), 1U);
  trainer.finish();
  EXPECT_EQ(counts.recordings().size(), 1U);
}

TEST(EvidenceTrainer, RefusesAWindowOfNoLength) {
  Statistics counts;
  EXPECT_THROW(Trainer(counts, 0), std::invalid_argument);
  EXPECT_THROW(Trainer(counts, -kWindow), std::invalid_argument);
}

TEST(EvidenceTrainer, TellsWhenEachTypeCameFirst) {
  const Statistics counts = countsOf(
      {inMilliseconds({{1000, kB}, {1010, kA}, {1020, kB}}), inMilliseconds({{5000, kA}})});
  ASSERT_EQ(counts.recordings().size(), 2U);
  EXPECT_EQ(counts.recordings()[0].firsts, (std::vector<std::int64_t>{10 * kMillisecond, 0}));
  EXPECT_EQ(counts.recordings()[1].firsts, (std::vector<std::int64_t>{0}));
}

TEST(EvidenceTrainer, WhatCameBeforeOnlyTellsWhenItCameFirst) {
  Statistics counts = countsOf({});
  Trainer trainer(counts, kWindow);
  trainer.startRecording({kSecond});
  trainer.addBefore({3 * kSecond, kB});
  trainer.addBefore({4 * kSecond, kB});
  for (const Event& event : timer(kA, 20 * kSecond, 30 * kSecond, kSecond)) {
    trainer.add(event);
    trainer.add({event.stamp, kB});
  }
  trainer.finish();
  Statistics same = countsOf({together({timer(kA, 20 * kSecond, 30 * kSecond, kSecond),
                                        timer(kB, 20 * kSecond, 30 * kSecond, kSecond)})});
  EXPECT_EQ(counts.type(kB).gaps, same.type(kB).gaps);
  EXPECT_EQ(counts.delays(kA, kB), same.delays(kA, kB));
  EXPECT_EQ(counts.duration(), same.duration());
  ASSERT_EQ(counts.recordings().size(), 1U);
  EXPECT_EQ(counts.recordings()[0].start, 20 * kSecond);
  EXPECT_EQ(counts.recordings()[0].firsts, (std::vector<std::int64_t>{19 * kSecond, 2 * kSecond}));
  EXPECT_FALSE(counts == same);
}

// A, and two modes.
const std::vector<EventType> kWithModes{{"/a", "/x", "T"},
                                        {"/logic", "/state", typeOfMode("T", "ONE")},
                                        {"/logic", "/state", typeOfMode("T", "TWO")}};
constexpr EventId kOne = 1;
constexpr EventId kTwo = 2;

TEST(EvidenceTrainer, AModeCountsAsItsTicks) {
  const Statistics counts = countsOf(
      {inMilliseconds(
          {{0, kOne}, {500, kA}, {2600, kA}, {2900, kTwo}, {5500, kA}, {5800, kOne}, {6500, kA}})},
      kWithModes);
  EXPECT_EQ(counts.type(kOne).events, 4U) << "at 0, 1, 2 s, and, after 3 s, at 5.9 s";
  EXPECT_EQ(counts.type(kOne).longest_gaps.front(), 3900 * kMillisecond);
  EXPECT_EQ(counts.type(kTwo).events, 3U) << "at 2.9, 3.9 and 4.9 s";
  EXPECT_EQ(counts.type(kTwo).rate_sum, 0U) << "no message comes";
  EXPECT_EQ(counts.delays(kA, kOne).total(), 3U) << "of its ticks after the first A";
  EXPECT_EQ(counts.delays(kA, kOne).at(log_bins::bin(1500 * kMillisecond)), 1U) << "at 2 s";
  EXPECT_EQ(counts.delays(kOne, kA).at(log_bins::bin(600 * kMillisecond)), 2U) << "at 2.6, 6.5 s";
  EXPECT_EQ(counts.recordings().front().firsts,
            (std::vector<std::int64_t>{500 * kMillisecond, 0, 2900 * kMillisecond}));
}

TEST(EvidenceTrainer, TheModeOfBeforeLastsFromTheFirstEventOn) {
  Statistics counts = countsOf({}, kWithModes);
  Trainer trainer(counts, kWindow);
  trainer.startRecording({kSecond});
  trainer.addBefore({3 * kSecond, kOne});
  trainer.add({20 * kSecond, kA});
  trainer.add({22 * kSecond + 1, kA});
  trainer.finish();
  EXPECT_EQ(counts.type(kOne).events, 3U);
  trainer.startRecording();
  trainer.add({30 * kSecond, kA});
  trainer.add({40 * kSecond, kA});
  trainer.finish();
  EXPECT_EQ(counts.type(kOne).events, 3U) << "another recording does not know it";
}

TEST(EvidenceTrainer, TheModeLastsOverAStepOfTheClock) {
  const Statistics counts =
      countsOf({{{20 * kSecond, kTwo}, {21 * kSecond, kA}, {5 * kSecond, kA}, {6 * kSecond, kA}}},
               kWithModes);
  EXPECT_EQ(counts.type(kTwo).events, 4U);
  EXPECT_EQ(counts.type(kTwo).gaps, 2U);
}

TEST(EvidenceStatistics, FirstTimesMeetTheirTypes) {
  Statistics other;
  other.intern(kTypes[kC]);
  other.intern(kTypes[kA]);
  other.addRecording({7, 9, 0, 0, {1, 1}, {0, 0}, {5, 3}});
  Statistics counts = countsOf({inMilliseconds({{1000, kB}})});
  counts.merge(other);
  ASSERT_EQ(counts.recordings().size(), 2U);
  EXPECT_EQ(counts.recordings()[0].firsts, (std::vector<std::int64_t>{3, -1, 5}));
  EXPECT_EQ(counts.recordings()[1].firsts, (std::vector<std::int64_t>{-1, 0}));
}

TEST(EvidenceStatistics, KeepTheLongestGaps) {
  Statistics::Type type;
  std::vector<std::int64_t> gaps(40);
  std::iota(gaps.begin(), gaps.end(), 1);
  std::shuffle(gaps.begin(), gaps.end(), std::mt19937(5));
  for (const std::int64_t gap : gaps) {
    type.addGap(gap);
  }
  ASSERT_EQ(type.longest_gaps.size(), Statistics::kLongestGaps);
  for (std::size_t k = 0; k < type.longest_gaps.size(); ++k) {
    EXPECT_EQ(type.longest_gaps[k], static_cast<std::int64_t>(40 - k));
  }
}

TEST(EvidenceStatistics, CountsOfTwoTrainingsEqualTrainingOnBoth) {
  const Events first = randomEvents(1, kA, kB);
  const Events second = randomEvents(2, kB, kC);
  Statistics sum = countsOf({first});
  const Statistics both = countsOf({first, second});
  EXPECT_FALSE(sum == both);
  sum.merge(countsOf({second}));
  EXPECT_TRUE(sum == both);
}

TEST(EvidenceStatistics, MergingCommutesUpToTheIds) {
  const Statistics first = countsOf({randomEvents(1, kA, kB)}, 2);
  const Statistics second = countsOf({randomEvents(2, 0, 1)}, {kTypes[kC], kTypes[kB]});
  Statistics one = first;
  one.merge(second);
  Statistics other = second;
  other.merge(first);
  EXPECT_FALSE(one == other);
  EXPECT_TRUE(reordered(one) == reordered(other));
  EXPECT_GT(one.total(kA, kB), 0U);
}

TEST(EvidenceStatistics, MergingKeepsTheRecordingsOfBothByTheirIds) {
  Statistics counts = countsOf({inMilliseconds({{9000, kA}, {9100, kA}, {9100, kB}})}, 2);
  const Statistics other =
      countsOf({inMilliseconds({{1000, 0}, {1300, 0}, {1350, 1}})}, {kTypes[kC], kTypes[kA]});
  counts.merge(other);
  ASSERT_EQ(counts.recordings().size(), 2U);
  EXPECT_EQ(counts.recordings()[0].events, (std::vector<std::uint64_t>{1, 0, 2}));
  EXPECT_EQ(counts.recordings()[0].longest_gaps,
            (std::vector<std::int64_t>{0, 0, 300 * kMillisecond}));
  EXPECT_EQ(counts.recordings()[0].longest_silence, 300 * kMillisecond);
  EXPECT_EQ(counts.recordings()[0].longest_stall, 0);
  EXPECT_EQ(counts.recordings()[1].events, (std::vector<std::uint64_t>{2, 1}));
  EXPECT_EQ(counts.only({}).recordings().size(), 2U);
}

TEST(EvidenceStatistics, PartnersComeInOrder) {
  Statistics counts = countsOf({}, 2);
  counts.setPartners(kA, partnersOf({{kB, 3, {}}}));
  EXPECT_EQ(counts.answers(kA, kB), 3U);
  EXPECT_EQ(counts.answers(kB, kA), 0U);
  EXPECT_THROW(counts.setPartners(kA, partnersOf({{kB, 3, {}}, {kA, 1, {}}})),
               std::invalid_argument);
  EXPECT_THROW(counts.setPartners(kA, partnersOf({{kB, 3, {}}, {kB, 1, {}}})),
               std::invalid_argument);
  EXPECT_THROW(counts.setPartners(kA, partnersOf({{kC, 1, {}}})), std::invalid_argument);
  counts.count(kA, {Partners::kNotSeen, 0}, {0, 0});
  const Partners& all = counts.partners(kA);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all.id(kA), kA);
  EXPECT_EQ(all.answers(kB), 3U);
}

}  // namespace
}  // namespace self_awareness::core::evidence
