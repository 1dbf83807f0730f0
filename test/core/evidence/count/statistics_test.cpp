#include "self_awareness/core/evidence/count/statistics.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "../recordings.h"
#include "core/evidence/count/log_bins.h"
#include "self_awareness/core/evidence/count/partners.h"
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
    events.push_back({stamp, static_cast<EventId>(first + random() % (last - first + 1)), {}});
    events.back().attributes.age = ageClass(static_cast<std::int64_t>(random() % 30000000));
    events.back().attributes.size = sizeClass(random() % 1000);
    events.back().attributes.same = random() % 2 == 0;
    events.back().attributes.step =
        random() % 9 == 0 ? Attributes::Step::kLostOne : Attributes::Step::kNext;
  }
  return events;
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
  EXPECT_NEAR(counts.rateVariance(kA), 19.0 / 3 - 7.0 / 3 * 7 / 3, 1e-12);
  EXPECT_EQ(counts.dispersion(kA), 1) << "a timer varies less than chance";
  EXPECT_THROW(Trainer(counts, 0), std::invalid_argument);
  EXPECT_THROW(Trainer(counts, -kWindow), std::invalid_argument);
}

TEST(EvidenceTrainer, SaysWhatEveryRecordingShowed) {
  const Statistics counts =
      countsOf({inMilliseconds({{9000, kB}, {9400, kB}, {9500, kA}}),
                inMilliseconds({{1000, kA}, {1100, kB}, {6150, kA}, {6900, kA}})});
  ASSERT_EQ(counts.recordings().size(), 2U);
  const Statistics::Recording& first = counts.recordings()[0];  // in the order of their start
  EXPECT_EQ(first.start, kSecond);
  EXPECT_EQ(first.end, 6900 * kMillisecond);
  EXPECT_EQ(first.longest_silence, 750 * kMillisecond) << "since it has settled";
  EXPECT_EQ(first.events, (std::vector<std::uint64_t>{3, 1}));
  EXPECT_EQ(first.longest_gaps, (std::vector<std::int64_t>{5150 * kMillisecond, 0}));
  const Statistics::Recording& second = counts.recordings()[1];
  EXPECT_EQ(second.start, 9 * kSecond);
  EXPECT_EQ(second.longest_silence, 0) << "it has not";
  EXPECT_EQ(second.events, (std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(second.longest_gaps, (std::vector<std::int64_t>{0, 400 * kMillisecond}));
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

TEST(EvidenceTrainer, TheModeOfBeforeLastsFromTheFirstEventOn) {
  constexpr EventId kOne = 1;
  Statistics counts = countsOf({}, {kTypes[kA], {"/logic", "/state", typeOfMode("T", "ONE")}});
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

TEST(EvidenceStatistics, CountsOfTwoTrainingsEqualTrainingOnBoth) {
  const Events first = randomEvents(1, kA, kB);
  const Events second = randomEvents(2, kB, kC);
  Statistics sum = countsOf({first});
  const Statistics both = countsOf({first, second});
  EXPECT_GT(both.type(kB).attributes.known(), sum.type(kB).attributes.known());
  EXPECT_FALSE(sum == both);
  sum.merge(countsOf({second}));
  EXPECT_TRUE(sum == both);
}

TEST(EvidenceStatistics, MergingKeepsTheRecordingsOfBothByTheirIds) {
  Statistics counts = countsOf({inMilliseconds({{9000, kA}, {9100, kA}, {9100, kB}})}, 2);
  const Statistics other = countsOf({inMilliseconds({{1000, 0}, {6100, 0}, {6400, 0}, {6450, 1}})},
                                    {kTypes[kC], kTypes[kA]});
  counts.merge(other);
  ASSERT_EQ(counts.recordings().size(), 2U);
  const Statistics::Recording& first = counts.recordings()[0];
  EXPECT_EQ(first.events, (std::vector<std::uint64_t>{1, 0, 3}));
  EXPECT_EQ(first.firsts, (std::vector<std::int64_t>{5450 * kMillisecond, -1, 0}));
  EXPECT_EQ(first.longest_gaps, (std::vector<std::int64_t>{0, 0, 5100 * kMillisecond}));
  EXPECT_EQ(first.longest_silence, 300 * kMillisecond);
  EXPECT_EQ(first.longest_stall, 0);
  EXPECT_EQ(counts.recordings()[1].events, (std::vector<std::uint64_t>{2, 1}));
  EXPECT_EQ(counts.recordings()[1].firsts, (std::vector<std::int64_t>{0, 100 * kMillisecond}));
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

constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();

Partner partner(EventId id, std::uint64_t answers, std::uint32_t count) {
  Partner partner;
  partner.id = id;
  partner.answers = answers;
  partner.delays[3] = count;
  return partner;
}

TEST(Partners, KeepCountsOfAnySize) {
  Partners partners;
  const std::vector<std::uint32_t> counts{1, 255, 256, 65535, 65536, kMost, 0};
  for (EventId id = 0; id < counts.size(); ++id) {
    partners.append(partner(2 * id, id, counts[id]));
  }
  ASSERT_EQ(partners.size(), counts.size());
  for (EventId id = 0; id < counts.size(); ++id) {
    EXPECT_TRUE(partners.at(id) == partner(2 * id, id, counts[id]));
    EXPECT_EQ(partners.total(id), counts[id]);
    EXPECT_EQ(partners.answers(id), id);
    EXPECT_EQ(partners.find(2 * id), id);
    EXPECT_FALSE(partners.find(2 * id + 1));
  }
  EXPECT_THROW(partners.append(partner(3, 0, 1)), std::invalid_argument);
  EXPECT_THROW(partners.append(partner(12, 0, 1)), std::invalid_argument);
}

TEST(Partners, CountOnAfterSomeWereKeptOnlyBeyondAByteAndTwo) {
  constexpr std::uint32_t kEvents = 70000;
  Partners partners;
  partners.append(partner(1, 5, 250));
  partners.makeAll(3);
  for (std::uint32_t k = 0; k < kEvents; ++k) {
    const std::uint8_t bin = k < 300 ? 3 : 49;
    partners.count({3, bin, Partners::kNotSeen}, {0, 1, 0});
  }
  ASSERT_EQ(partners.size(), 3U);
  EXPECT_TRUE(partners.at(0) == partner(0, 0, kEvents));
  EXPECT_EQ(partners.at(1).delays[3], 550U);
  EXPECT_EQ(partners.at(1).delays[49], kEvents - 300);
  EXPECT_EQ(partners.at(1).answers, kEvents + 5);
  EXPECT_EQ(partners.total(2), 0U);
  partners.makeAll(5);
  partners.count({3, Partners::kNotSeen, 3, 4}, {1, 2});  // two events, of the first two types
  EXPECT_EQ(partners.at(0).delays[3], kEvents + 2);
  EXPECT_EQ(partners.at(1).delays[4], 1U);
  EXPECT_EQ(partners.at(1).answers, kEvents + 7);
  EXPECT_THROW(partners.count({3, 3, 3}, {0, 0}), std::invalid_argument);
  EXPECT_EQ(partners.total(4), 0U);
}

TEST(Partners, AddUpAndStayAtTheLargestNumber) {
  Partners a;
  a.append(partner(1, 2, 200));
  a.append(partner(4, 1, kMost - 5));
  Partners b;
  b.append(partner(0, 7, 1));
  b.append(partner(1, 3, 100));
  b.append(partner(4, 1, 10));
  for (const Partners& both : {Partners::sum(a, b), Partners::sum(b, a)}) {
    ASSERT_EQ(both.size(), 3U);
    EXPECT_TRUE(both.at(0) == partner(0, 7, 1));
    EXPECT_TRUE(both.at(1) == partner(1, 5, 300));
    EXPECT_TRUE(both.at(2) == partner(4, 2, kMost));
  }
}

}  // namespace
}  // namespace self_awareness::core::evidence
