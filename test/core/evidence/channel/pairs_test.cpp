#include "core/evidence/channel/pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "channel_case.h"
#include "core/evidence/channel/delays.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kLate = 62 * kMillisecond;

class PairsTest : public FollowedTest {
 protected:
  using FollowedTest::evidence;
  double evidence() { return evidence(pair_); }
  Suspect suspect() { return FollowedTest::suspect(pair_); }
  // Asks for so long, and returns for how long the evidence was above the limit [ns].
  template <typename Delay>
  std::int64_t abnormalFor(std::int64_t length, Delay delay) {
    std::int64_t abnormal = 0;
    int number = 0;
    for (const std::int64_t end = now_ + length; now_ < end;) {
      ask(delay(number++));
      abnormal += evidence() > kLimit ? kPeriod : 0;
    }
    return abnormal;
  }

  bool isWatched() const { return scorer_.raisedBy(pair_) == 0; }

  std::size_t pair_ = track(kPairs, kB, kA);
};

const auto kAlwaysLate = [](int) { return kUnusual; };

TEST_F(PairsTest, LateAnswersAreNewsOnceAndThenAccepted) {
  useLimits();
  askUsually(kArming);
  const std::int64_t abnormal = abnormalFor(10 * kAccepted, kAlwaysLate);
  EXPECT_GE(abnormal, kAccepted);
  EXPECT_LT(abnormal, kAccepted + kSecond);
  EXPECT_EQ(evidence(), 0);
}

TEST_F(PairsTest, WhatWasAcceptedIsHarderToArmAgain) {
  useLimits();
  EXPECT_FALSE(isWatched()) << "it has not been as in training yet";
  askUsually(kArming);
  EXPECT_TRUE(isWatched());
  do {
    ask(kUnusual);
  } while (evidence() > 0);
  EXPECT_FALSE(isWatched());
  askUsually(2 * kArming - 1);
  EXPECT_FALSE(isWatched()) << "as many as at the start are not enough";
  askUsually(1);
  EXPECT_TRUE(isWatched());
  ask(kUnusual);
  EXPECT_GT(evidence(), 0);
}

TEST_F(PairsTest, ABlockWithUnusualDelaysIsNotAsInTraining) {
  useLimits();
  askUsually(kArming - 3);
  for (int k = 0; k < 3; ++k) {
    ask(kUnusual);
  }
  EXPECT_FALSE(isWatched()) << "though most of them speak for training";
}

TEST_F(PairsTest, NothingIsAcceptedWhileLimitsAreNotKnown) {
  askUsually(kArming);
  abnormalFor(2 * kAccepted, kAlwaysLate);
  EXPECT_GT(evidence(), kLimit);
}

TEST_F(PairsTest, WhatIsUsualAgainInBetweenIsNewsAgain) {
  useLimits();
  askUsually(kArming);
  std::int64_t abnormal = 0;
  for (int times = 0; times < 3; ++times) {
    abnormal += abnormalFor(kAccepted * 2 / 3, kAlwaysLate);
    EXPECT_GT(evidence(), kLimit) << times;
    askUsually(kArming << (times + 2));  // also to come down from the cap
    EXPECT_EQ(evidence(), 0) << times;
  }
  EXPECT_GT(abnormal, kAccepted * 3 / 2);
}

TEST_F(PairsTest, ASuspectIsToldOfByTheDelaysSinceTheSumWasZero) {
  askUsually(50);
  const std::int64_t first = now_ + kLate;
  for (int i = 0; i < 6; ++i) {
    ask(kLate + i * kMillisecond / 10);
  }
  ask(kUsual);
  const Reason found = suspect().reason;
  EXPECT_EQ(found.kind, Kind::kLate);
  EXPECT_EQ(found.after, toString(kTypes[kA]));
  EXPECT_DOUBLE_EQ(found.lasted, toSeconds(now_ - first));
  EXPECT_EQ(found.of, 7U);
  EXPECT_EQ(found.times, 6U);
  EXPECT_DOUBLE_EQ(found.usual, 1e-9 * kUsual);
  EXPECT_DOUBLE_EQ(found.value, toSeconds(kLate + 3 * kMillisecond / 10)) << "the median of six";
  EXPECT_EQ(found.words,
            "42.3 ms later than usual 6 times of 7 after /a /x T in the last 1.3 s, usually "
            "0.020 s");
}

TEST_F(PairsTest, WhatIsUsualIsWhatCameBeforeInTheSameRecording) {
  for (int i = 0; i < 50; ++i) {
    ask(kUsual + kMillisecond);
  }
  ask(kLate);
  EXPECT_DOUBLE_EQ(suspect().reason.usual, 1e-9 * (kUsual + kMillisecond));
  restart();
  askUsually(3);  // too few
  ask(kLate);
  EXPECT_DOUBLE_EQ(suspect().reason.usual, 1e-9 * model_->usualDelay(kA, kB, 0.5));
}

TEST_F(PairsTest, WithoutUnusualDelaysTheLastOneIsTold) {
  const Reason none = suspect().reason;
  EXPECT_EQ(none.words, "at unusual delays after /a /x T");
  EXPECT_EQ(none.kind, Kind::kOutOfOrder);
  EXPECT_TRUE(std::isnan(none.value)) << "it says no number";
  add({now_, kB});  // after no A
  EXPECT_EQ(suspect().reason.of, 0U);
  askUsually(10);
  EXPECT_EQ(suspect().reason.of, 1U);
  EXPECT_EQ(suspect().reason.times, 0U);
  EXPECT_DOUBLE_EQ(suspect().reason.value, 1e-9 * kUsual);
  add({now_, kA});
  add({now_ + kLate, kB});
  for (int i = 1; i < 10; ++i) {  // B goes on without A, which is stale
    add({now_ + i * kPeriod, kB});
  }
  EXPECT_EQ(suspect().reason.of, 1U);
  EXPECT_DOUBLE_EQ(suspect().reason.value, 1e-9 * kLate);
}

TEST_F(PairsTest, WhatIsToldIsWhatTheSumSaw) {
  std::mt19937 random(1);
  int unusual = 0;
  for (int i = 0; i < 2000; ++i) {
    ask(i < 40 || random() % 8 != 0 ? kUsual : kLate);
    EXPECT_EQ(suspect().reason.times > 0, evidence() > 0) << i;
    unusual += evidence() > 0 ? 1 : 0;
  }
  EXPECT_GT(unusual, 100);
  EXPECT_LT(unusual, 1900);
}

// More than chance [nat].
constexpr double kLeastStep = 1.5;

DelaySteps stepsOf(const Watched& watched) {
  return DelaySteps(Model(watched), kA, kB);
}

// B comes so much after A [ns].
Watched twoStarts(std::int64_t delay) {
  return watch(startOf(followed(1, 100 * kSecond, delay), 1),
               startOf(followed(2, 100 * kSecond, delay), 2));
}

TEST(DelaySteps, AreBounded) {
  const Watched watched = twoStarts(20 * kMillisecond);
  const DelaySteps steps = stepsOf(watched);
  double largest = 0;
  for (std::int64_t delay = 0; delay < 20 * kSecond; delay += kMillisecond) {
    largest = std::max(largest, steps(delay));
  }
  EXPECT_LT(steps(20 * kMillisecond), 0);
  EXPECT_LT(steps(10 * kSecond), 0) << "A pauses, B goes on";
  const Model model(watched);
  const std::size_t track = indexOf(model.tracks(), kPairs, kB, kA);
  EXPECT_LE(2 * largest, model.leastLimit(track)) << "one late event makes two unusual delays";
}

TEST(DelaySteps, SmallEffectsAreNoFault) {
  const DelaySteps steps = stepsOf(twoStarts(kMillisecond));
  for (const std::int64_t milliseconds : {0, 1, 3, 5}) {
    EXPECT_LE(steps(milliseconds * kMillisecond), 0) << milliseconds;
  }
  for (const std::int64_t milliseconds : {30, 60, 100}) {
    EXPECT_GT(steps(milliseconds * kMillisecond), kLeastStep) << milliseconds;
  }
}

TEST(DelaySteps, ADelayNearZeroIsANeighbourOfAPeriod) {
  const Events timers = together({timer(kA, 0, 100 * kSecond, 100 * kMillisecond),
                                  timer(kB, kMillisecond, 100 * kSecond, 100 * kMillisecond)});
  const DelaySteps steps = stepsOf(watch(startOf(timers, 1), startOf(timers, 2)));
  EXPECT_LE(steps(99 * kMillisecond), 0);
  EXPECT_GT(steps(50 * kMillisecond), kLeastStep);
}

/// Delays in words: of so many [s], half of them unusual; the usual one came often before.
std::string wordsOf(const std::vector<double>& unusual, const std::string& other, Kind kind) {
  std::vector<SeenDelay> seen;
  std::int64_t now = 0;
  for (int k = 0; k < 20; ++k) {
    seen.push_back({now += 100 * kMillisecond, 45e6, -1});
  }
  const std::int64_t since = now + 100 * kMillisecond;
  for (const double delay : unusual) {
    seen.push_back({now += 100 * kMillisecond, delay * 1e9, 3});
    seen.push_back({now += 100 * kMillisecond, 45e6, -1});
  }
  Reason reason;
  reason.after = other;
  describeDelays(seen, 100, 30e6, since + 12040 * kMillisecond, {}, reason);
  EXPECT_EQ(reason.unit, unit::kSeconds);
  EXPECT_EQ(reason.kind, kind) << reason.words;
  return reason.words;
}

TEST(DescribeDelays, SaysHowMuchLaterHowOftenAndSinceWhen) {
  const std::string since = " after /a /x T in the last 12.0 s, usually 0.045 s";
  const auto said = [&](const std::vector<double>& unusual, Kind kind) {
    return wordsOf(unusual, "/a /x T", kind);
  };
  EXPECT_EQ(said({0.0471, 0.0471, 0.0471}, Kind::kLate),
            "2.1 ms later than usual 3 times of 6" + since);
  EXPECT_EQ(said({0.0429, 0.0429}, Kind::kEarly),
            "2.1 ms earlier than usual 2 times of 4" + since);
  EXPECT_EQ(said({0.245}, Kind::kLate), "200 ms later than usual 1 time of 2" + since);
  EXPECT_EQ(said({3.045}, Kind::kLate), "3.00 s later than usual 1 time of 2" + since);
  EXPECT_EQ(said({0.033, 0.057, 0.033, 0.057}, Kind::kOutOfOrder),
            "12.0 ms earlier or later than usual 4 times of 8" + since);
}

}  // namespace
}  // namespace self_awareness::core::evidence
