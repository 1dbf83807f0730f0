#include "core/evidence/watch/gain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "../recordings.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kLength = 60 * kSecond;
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
  // P: 51 and 1 of 100; Q: 51 and 101 of 200.
  EXPECT_NEAR(gain(kA, kB), (30 * std::log(2.0) + 20 * std::log(2.0 / 101)) / 50, 1e-12);
  EXPECT_EQ(gain(kA, kA), 0);  // not measured
  EXPECT_EQ(gain(kB, kA), 0);  // not learned
  measured.setPartners(kB, after(kA, {{10, 30}, {20, 19}}));
  EXPECT_EQ(gain(kA, kB), 0);  // too little to measure on
}

TEST(InformationGain, IsZeroForATypeThatTheOtherHalfLacks) {
  const Statistics learned = startOf(followed(1, kLength), 1);
  const Statistics measured = countsOf({irregular(kA, 0, kLength, 200 * kMillisecond, 2)}, 1);
  EXPECT_GT(InformationGain(learned, learned, kFewestDelays)(kA, kB), 0.3);
  EXPECT_EQ(InformationGain(learned, measured, kFewestDelays)(kA, kB), 0);
}

TEST(Gains, AreTheMeanOfLearningFromEitherHalf) {
  const Statistics first = startOf(followed(1, kLength), 1);
  const Statistics second = startOf(followed(2, kLength), 2);
  const Gains gains({&first, &second}, kFewestDelays);
  const InformationGain one(first, second, kFewestDelays);
  const InformationGain other(second, first, kFewestDelays);
  for (const EventId from : {kA, kB}) {
    for (const EventId to : {kA, kB}) {
      EXPECT_NEAR(gains(from, to), (one(from, to) + other(from, to)) / 2, 1e-12);
    }
  }
  EXPECT_GT(gains(kA, kB), gains(kB, kA));
}

}  // namespace
}  // namespace self_awareness::core::evidence
