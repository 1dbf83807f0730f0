#include "self_awareness/core/evidence/count/attribute_counts.h"

#include <gtest/gtest.h>

#include "../recordings.h"
#include "core/evidence/count/age_level.h"
#include "core/evidence/count/repeats.h"

namespace self_awareness::core::evidence {
namespace {

TEST(AgeLevel, WhatIsOlderThanOfLateIsARise) {
  AgeLevel level;
  EXPECT_EQ(level.add(0, 5), 0);  // clocks of two computers may differ
  EXPECT_EQ(level.add(kSecond, 5.4), 0) << "that is the next class of ages";
  EXPECT_NEAR(level.add(kSecond, 6.5), 1.5 - Attributes::kAgeStep * 5, 1e-9);
  EXPECT_EQ(level.add(2 * kSecond, 4.5), 0);
  EXPECT_NEAR(level.add(3 * kSecond, 5.5), 1 - Attributes::kAgeStep * 4.5, 1e-9);
}

TEST(AgeLevel, AStampOfTheFutureIsOneUntilAllAreSo) {
  AgeLevel level;
  level.add(0, 0.02);
  EXPECT_NEAR(level.add(kSecond, -2), 2.02, 1e-9);
  EXPECT_EQ(level.add(2 * kSecond, 0.02), 0);  // the one that was wrong says nothing of others
  for (int second = 3; second < 200; ++second) {
    level.add(second * kSecond, -2);
  }
  EXPECT_EQ(level.add(200 * kSecond, -2), 0);
}

TEST(AgeLevel, WhoIsTooOldSaysNothingOfWhatIsUsualHoweverLongThatLasts) {
  constexpr double kMost = 1;
  AgeLevel level;
  level.add(0, 0.02, {0, 0.1}, kMost);
  for (int second = 1; second < 600; ++second) {
    EXPECT_GT(level.add(second * kSecond, 3, {0, 0.1}, kMost), 2.9) << second;
  }
  EXPECT_EQ(level.add(600 * kSecond, 0.02, {0, 0.1}, kMost), 0);
  for (int second = 601; second < 1200; ++second) {
    EXPECT_GT(level.add(second * kSecond, -3, {0, 0.1}, kMost), 2.9) << second;
  }
}

TEST(AgeLevel, WhoComesBackToWhatIsUsualIsSoAfterAWhile) {
  AgeLevel level;
  level.add(0, -3, {0, 0.1}, 1);  // one wrong stamp, or a clock that was ahead
  double older = 0;
  for (int second = 1; second < 200; ++second) {
    older = level.add(second * kSecond, 0.02, {0, 0.1}, 1);
    EXPECT_EQ(older > 1, second < 120) << second;
  }
}

TEST(AgeLevel, WhoWasLateAndComesBackToWhatIsUsualIsNotAhead) {
  AgeLevel level;
  level.add(0, -12.5, {-15, -12.5});  // its clock is 15 s ahead, and the message had waited
  EXPECT_EQ(level.add(kSecond, -15, {-15, -12.5}), 0);
  EXPECT_EQ(level.add(2 * kSecond, -17.8, {-15, -12.5}), 0) << "the next class";
  EXPECT_EQ(level.add(3 * kSecond, -25, {-15, -12.5}), 25 - 17.8);
}

TEST(AttributeCounts, CountsWhatMessagesAre) {
  const auto counted = [](const Source& source) {
    return countsOf({messages(kA, kStart, kStart + 100 * kSecond, source)}, 1).type(kA).attributes;
  };
  const AttributeCounts usual = counted({});
  EXPECT_EQ(usual.known(), 1000U);
  EXPECT_EQ(usual.counted(), 950U);  // without those of its start
  EXPECT_EQ(usual.numbered(), 950U);
  EXPECT_EQ(usual.losses(), 0U);
  EXPECT_EQ(usual.repeats, 0U);
  EXPECT_EQ(total(usual.rises), 950U);
  EXPECT_NEAR(ageOf(quantile(usual.ages, 0.5)), 0.02, 0.002);
  EXPECT_EQ(quantile(usual.sizes, 0), sizeClass(800));
  EXPECT_EQ(quantile(usual.sizes, 1), sizeClass(800));
  Source source;
  source.lost = 0.1;
  source.repeats = true;
  const AttributeCounts faulty = counted(source);
  EXPECT_NEAR(static_cast<double>(faulty.losses()), 100, 40);
  EXPECT_EQ(faulty.repeats, 950U);
  EXPECT_NEAR(toSeconds(faulty.longest_repeat), 95, 0.2);
}

TEST(AttributeCounts, AStartIsThatOfTheRecording) {
  Statistics counts = countsOf({}, 1);
  Trainer trainer(counts, kWindow);
  trainer.startRecording();
  trainer.addBefore({kStart - 10 * kSecond, kA});
  addAll(trainer, messages(kA, kStart, kStart + 100 * kSecond, {}));
  trainer.finish();
  EXPECT_EQ(counts.type(kA).attributes.counted(), 1000U);
}

}  // namespace
}  // namespace self_awareness::core::evidence
