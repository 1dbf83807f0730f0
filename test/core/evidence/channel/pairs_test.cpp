#include "core/evidence/channel/pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <vector>

#include "channel_case.h"
#include "core/evidence/channel/delays.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kLate = 62 * kMillisecond;
constexpr std::int64_t kEarly = 3 * kMillisecond;

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

  bool isWatched() const {
    const std::vector<std::size_t> disarmed = scorer_.disarmed();
    return std::find(disarmed.begin(), disarmed.end(), pair_) == disarmed.end();
  }

  std::size_t pair_ = track(kPairs, kB, kA);
};

const auto kAlwaysLate = [](int) { return kUnusual; };

TEST_F(PairsTest, DelaysAddUpAsInACusumTest) {
  const DelaySurprise surprise_of(*model_, watched_.halves, kA, kB);
  double sum = 0;
  double regime = 0;  // of the last two minutes
  std::optional<std::int64_t> last;
  const auto add = [&](std::int64_t delay) {
    const std::int64_t stamp = now_ + delay;
    const double surprise = surprise_of(delay);
    sum = std::max(sum + surprise - std::max(regime, 0.0) - 1, 0.0);
    regime += (surprise - regime) * toSeconds(last ? stamp - *last : 0) / 120;
    last = stamp;
    ask(delay);
  };
  for (int i = 0; i < kArming; ++i) {
    add(kUsual);
    EXPECT_EQ(sum, 0) << "usual delays do not let it fall below 0";
  }
  for (const std::int64_t delay : {kUnusual, kUnusual, kUsual, kUnusual, kUsual, kUsual}) {
    add(delay);
    EXPECT_NEAR(evidence(), sum, 1e-12);
  }
  EXPECT_GT(sum, 0);
}

TEST_F(PairsTest, NoSumGrowsFarBeyondItsLimit) {
  useLimits();
  askUsually(kArming);
  for (int i = 0; i < 30; ++i) {
    ask(kUnusual);
  }
  EXPECT_DOUBLE_EQ(evidence(), 1.5 * kLimit);
}

TEST_F(PairsTest, AStalePredecessorCountsOnce) {
  askUsually(kArming);
  add({now_, kA});
  add({now_ + kUnusual, kB});
  const double once = evidence();
  EXPECT_GT(once, 0);
  for (int i = 1; i < 10; ++i) {  // B goes on without A
    add({now_ + i * kPeriod, kB});
  }
  EXPECT_EQ(evidence(), once);
}

TEST_F(PairsTest, WhatWasNeverHeardHasNoDelay) {
  for (int i = 0; i < 10 * kArming; ++i) {
    add({now_ += kPeriod, kB});
    ASSERT_EQ(evidence(), 0);
  }
  askUsually(kArming - 2);
  ask(kUnusual);
  EXPECT_EQ(evidence(), 0) << "nor does it arm";
}

TEST_F(PairsTest, DelaysThatNeverWereAsInTrainingSayNothing) {
  for (int i = 0; i < 10 * kArming; ++i) {
    ask(kUnusual);
  }
  EXPECT_EQ(evidence(), 0);
}

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
  askUsually(2 * kArming - 2);
  ask(kUnusual);
  EXPECT_EQ(evidence(), 0) << "as many as at the start are not enough";
  EXPECT_FALSE(isWatched());
  askUsually(2);
  EXPECT_TRUE(isWatched());
  ask(kUnusual);
  EXPECT_GT(evidence(), 0);
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

TEST_F(PairsTest, UnusualDelaysThatPassedAreForgotten) {
  useLimits();
  askUsually(50);
  for (int i = 0; i < 100; ++i) {
    ask(kLate);
  }
  askUsually(50);  // enough to come down from the cap
  ask(kEarly);
  EXPECT_EQ(suspect().reason.of, 1U);
  EXPECT_DOUBLE_EQ(suspect().reason.value, 1e-9 * kEarly);
}

TEST_F(PairsTest, WithoutUnusualDelaysTheLastOneIsTold) {
  EXPECT_EQ(suspect().reason.words, "at unusual delays after /a /x T");
  add({now_, kB});  // after no A
  EXPECT_EQ(suspect().reason.of, 0U);
  askUsually(10);
  EXPECT_EQ(suspect().reason.of, 1U);
  EXPECT_EQ(suspect().reason.times, 0U);
  EXPECT_DOUBLE_EQ(suspect().reason.value, 1e-9 * kUsual);
}

TEST_F(PairsTest, OfAStalePredecessorOneDelayIsTold) {
  askUsually(20);
  add({now_, kA});
  add({now_ + kLate, kB});
  for (int i = 1; i < 10; ++i) {  // B goes on without A
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

TEST_F(PairsTest, WhatHasBeenLateForMinutesIsTheRegime) {
  askUsually(50);
  for (int i = 0; i < 20; ++i) {
    ask(kLate);
  }
  EXPECT_EQ(suspect().reason.times, 20U);
  for (int i = 0; i < 3000; ++i) {  // ten minutes
    ask(kLate);
  }
  EXPECT_EQ(suspect().reason.times, 0U);
}

}  // namespace
}  // namespace self_awareness::core::evidence
