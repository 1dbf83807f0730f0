#include "core/evidence/channel/own_gaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "channel_case.h"
#include "core/evidence/channel/delays.h"
#include "self_awareness/core/evidence/limits/coverage.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kLong = 600 * kMillisecond;

// A is a timer; what comes at random beside it says nothing of it.
class OwnGapsTest : public ChannelTest {
 protected:
  OwnGapsTest() : ChannelTest(watch(timerAmongOthers(1), timerAmongOthers(2))) {
    EXPECT_FALSE(isWatched(model_->tracks(), kPairs, kA, kC));
  }

  static Statistics timerAmongOthers(unsigned seed) {
    return startOf(together({timer(kA, 0, 100 * kSecond, kPeriod),
                             irregular(kC, 0, 100 * kSecond, 50 * kMillisecond, seed)}),
                   seed);
  }
  // Adds an A so long after the last one; until then, the robot is not silent.
  void wait(std::int64_t gap) {
    for (std::int64_t at = 10 * kMillisecond; at < gap; at += 10 * kMillisecond) {
      add({now_ + at, kC});
    }
    now_ += gap;
    add({now_, kA});
    scorer_.closeWindow(now_);
  }
  void waitUsually(int times) {
    for (int i = 0; i < times; ++i) {
      wait(kPeriod);
    }
  }
  double evidence() { return ChannelTest::evidence(gaps_); }
  Suspect suspect() { return ChannelTest::suspect(gaps_); }

  std::size_t gaps_ = track(kOwnGaps, kA, kA);
  DelaySurprise surprise_{*model_, watched_.halves, kA, kA};
};

TEST(OwnGapsOfSlowTimersTest, NeedNoMoreGapsThanToMeasureWhatTheySay) {
  const auto slow = [](int gaps) {
    const Events timers = together(
        {timer(kA, 0, gaps * kSecond + 1, kSecond), timer(kC, 0, gaps * kSecond, kPeriod)});
    return watch(countsOf({timers}), countsOf({later(timers)}));
  };
  const auto fewest = static_cast<int>(Tuning{}.fewest_gaps);
  EXPECT_FALSE(isWatched(Model(slow(fewest - 1)).tracks(), kOwnGaps, kA, kA));
  EXPECT_TRUE(isWatched(Model(slow(fewest)).tracks(), kOwnGaps, kA, kA));
}

TEST_F(OwnGapsTest, ASumThatReachedItsCapHasNoLimit) {
  // As of a robot that sends at other rates in other modes: nobody knows how far it would grow.
  const Expectation& expected = model_->expectation(gaps_);
  EXPECT_EQ(expected.limit(gaps_, DelaySum::kMost - 1, 300), 300);
  EXPECT_TRUE(std::isnan(expected.limit(gaps_, DelaySum::kMost, 300)));
  const std::vector<Coverage> coverage =
      coverageOf(*model_, allLimits(*model_, kNone), {}, kWindow, false);
  ASSERT_EQ(coverage[model_->componentIndex(kA)].blind.size(), 1U);
  EXPECT_EQ(coverage[model_->componentIndex(kA)].blind[0].about, "pace");
  EXPECT_EQ(coverage[model_->componentIndex(kA)].blind[0].topic, kTypes[kA].scope);
}

TEST_F(OwnGapsTest, HaveAtLeastTwiceWhatWasSeen) {
  EXPECT_EQ(OwnGaps().margins(Tuning{}).least, 2);
}

TEST_F(OwnGapsTest, CountFromTheFirstOneOn) {
  add({now_, kA});
  wait(kPeriod);
  EXPECT_EQ(evidence(), 0);
  wait(kLong);
  EXPECT_GT(surprise_(kLong), 3);
  EXPECT_NEAR(evidence(), surprise_(kLong) - 1, 0.1) << "a type of its own has no phase";
}

TEST_F(OwnGapsTest, AddUpAsInACusumTest) {
  add({now_, kA});
  double sum = 0;
  double regime = 0;  // of the last two minutes
  for (const std::int64_t gap : {kPeriod, kPeriod, kLong, kLong, kPeriod, kLong, kPeriod}) {
    const double surprise = surprise_(gap);
    sum = std::max(sum + surprise - std::max(regime, 0.0) - 1, 0.0);
    regime += (surprise - regime) * toSeconds(gap) / 120;
    wait(gap);
    EXPECT_NEAR(evidence(), sum, 1e-12);
  }
  EXPECT_GT(sum, 0);
}

TEST_F(OwnGapsTest, WhoWaitedAndCatchesUpMakesItsSurpriseGood) {
  const auto afterLong = [&](std::int64_t next) {
    restart();
    add({now_, kA});
    waitUsually(10);
    wait(kLong);
    const double once = evidence();
    wait(next);
    return evidence() - once;
  };
  EXPECT_GT(surprise_(kMillisecond), 3) << "it is unusual";
  EXPECT_LT(afterLong(kMillisecond), 0);
  EXPECT_GT(afterLong(kLong), 0);
  restart();
  add({now_, kA});
  waitUsually(10);
  wait(kMillisecond);
  EXPECT_GT(evidence(), 0) << "it was not behind";
}

TEST_F(OwnGapsTest, WhatMayHaveWaitedForAStallDoesNotCount) {
  add({now_, kA});
  waitUsually(10);
  now_ += kLong;  // nobody says anything
  add({now_, kA});
  EXPECT_TRUE(scorer_.stalled());
  EXPECT_EQ(evidence(), 0);
  for (int i = 0; i < 10; ++i) {
    wait(kPeriod);
  }
  EXPECT_FALSE(scorer_.stalled());
}

TEST_F(OwnGapsTest, AfterARestartOfTheComponentTheSumIsForgotten) {
  add({now_, kA});
  waitUsually(10);
  wait(kLong);
  EXPECT_GT(evidence(), 0);
  wait(6 * kPeriod);
  EXPECT_EQ(evidence(), 0) << "so long a gap is that of a restart";
  wait(kPeriod);
  wait(kLong);
  EXPECT_GT(evidence(), 0) << "at once";
}

TEST_F(OwnGapsTest, ANewPeriodIsNewsOnceAndThenAccepted) {
  useLimits();
  EXPECT_TRUE(scorer_.disarmed().empty()) << "gaps count from the first one on";
  add({now_, kA});
  waitUsually(10);
  const std::int64_t since = now_;
  do {
    wait(kLong);
  } while (evidence() > 0);
  EXPECT_GE(now_ - since, kAccepted);
  EXPECT_LT(now_ - since, kAccepted + 5 * kSecond);
  EXPECT_EQ(scorer_.disarmed().size(), 1U);
  waitUsually(2 * kArming - 2);
  wait(kLong);
  EXPECT_EQ(evidence(), 0) << "it must be as in training again, for twice as many gaps";
  waitUsually(2);
  EXPECT_TRUE(scorer_.disarmed().empty());
  wait(kLong);
  EXPECT_GT(evidence(), 0);
}

TEST_F(OwnGapsTest, NoSumGrowsFarBeyondItsLimit) {
  useLimits();
  add({now_, kA});
  for (int i = 0; i < 30; ++i) {
    wait(kLong);
  }
  EXPECT_DOUBLE_EQ(evidence(), 1.5 * kLimit);
}

TEST_F(OwnGapsTest, ASuspectIsToldOfByTheGapsThatTheSumSaw) {
  EXPECT_EQ(suspect().reason.words, "at unusual delays");
  add({now_, kA});
  waitUsually(20);
  for (int i = 0; i < 4; ++i) {
    wait(kLong);
  }
  EXPECT_EQ(suspect().reason.words, "every 0.6 s instead of 0.2 s, 4 times in the last 1.8 s");
  EXPECT_EQ(suspect().reason.after, "");
  EXPECT_NEAR(suspect().reason.usual_shortest, 0.2, 0.03);
  EXPECT_NEAR(suspect().reason.usual_longest, 0.2, 0.03);
}

}  // namespace
}  // namespace self_awareness::core::evidence
