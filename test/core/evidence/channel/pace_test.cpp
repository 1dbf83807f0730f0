#include "core/evidence/channel/pace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "channel_case.h"
#include "self_awareness/core/evidence/limits/coverage.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kLong = 400 * kMillisecond;
constexpr std::int64_t kShort = 100 * kMillisecond;

double leastOf(const Model& model, const std::string& pace, EventId id) {
  return model.leastLimit(indexOf(model.tracks(), pace, id, id));
}

// A is a timer; what comes at random beside it says nothing of it.
class PaceTest : public ChannelTest {
 protected:
  PaceTest() : ChannelTest(watch(timerAmongOthers(1), timerAmongOthers(2))) {}

  static Statistics timerAmongOthers(unsigned seed) {
    return startOf(together({timer(kA, 0, 100 * kSecond, kPeriod),
                             irregular(kC, 0, 100 * kSecond, 50 * kMillisecond, seed)}),
                   seed);
  }
  // Adds As, each so long after the last one; until then, the robot is not silent.
  void wait(std::int64_t gap, int times = 1, const Attributes& attributes = {}) {
    for (int i = 0; i < times; ++i) {
      for (std::int64_t at = 10 * kMillisecond; at < gap; at += 10 * kMillisecond) {
        add({now_ + at, kC});
      }
      add({now_ += gap, kA, attributes});
      scorer_.closeWindow(now_);
    }
  }
  double slower() { return evidence(slower_); }
  double faster() { return evidence(faster_); }

  std::size_t slower_ = track(kSlower, kA, kA);
  std::size_t faster_ = track(kFaster, kA, kA);
};

TEST_F(PaceTest, OtherGapsSpeakForIt) {
  add({now_, kA});
  wait(kPeriod, 10);
  EXPECT_EQ(slower(), 0);
  EXPECT_EQ(faster(), 0);
  for (const std::int64_t gap : {3 * kPeriod / 2, kLong}) {
    wait(kPeriod, 60);
    wait(gap, 3);
    EXPECT_GT(slower(), model_->leastLimit(slower_)) << gap;
    EXPECT_LT(faster(), 2) << gap;
  }
  for (const std::int64_t gap : {2 * kPeriod / 3, kShort, kPeriod / 4}) {
    wait(kPeriod, 60);
    wait(gap, gap > kPeriod / 4 ? 3 : 9);
    EXPECT_GT(faster(), model_->leastLimit(faster_)) << gap;
    EXPECT_LT(slower(), 2) << gap;
  }
}

TEST_F(PaceTest, ABitLongerOrLostOnTheWayIsNoOtherPace) {
  add({now_, kA});
  wait(115 * kPeriod / 100, 100);
  wait(88 * kPeriod / 100, 100);
  Attributes lost;
  lost.step = Attributes::Step::kLostOne;
  wait(kLong, 1, lost);
  EXPECT_EQ(slower(), 0);
  EXPECT_EQ(faster(), 0);
}

TEST_F(PaceTest, AHiccupIsMadeUpForByTheGapsThatFollow) {
  add({now_, kA});
  wait(kPeriod, 10);
  wait(2 * kPeriod);
  const double once = slower();
  EXPECT_GT(once, 0);
  EXPECT_LT(once, model_->leastLimit(slower_)) << "one message is lost";
  wait(2 * kPeriod);
  EXPECT_LE(slower(), model_->leastLimit(slower_)) << "nor are two enough";
  wait(kPeriod, 20);
  wait(2 * kPeriod);
  EXPECT_DOUBLE_EQ(slower(), once);
  wait(kPeriod);
  EXPECT_NEAR(slower(), once - std::log(2), 0.05) << "half of the gaps are of another pace";
  wait(kPeriod, 60);
  EXPECT_EQ(slower(), 0);
}

TEST_F(PaceTest, WhatWaitedAndComesAtOnceIsNotFaster) {
  add({now_, kA});
  wait(kPeriod, 10);
  wait(5 * kPeriod);
  wait(kMillisecond, 4);
  EXPECT_EQ(faster(), 0);
  wait(kPeriod, 10);
  wait(7 * kPeriod);  // as of a restart
  wait(kMillisecond, 6);
  EXPECT_EQ(faster(), 0);
  wait(kPeriod, 3);
  wait(kPeriod / 4, 9);
  EXPECT_GT(faster(), model_->leastLimit(faster_)) << "nothing waited";
}

TEST_F(PaceTest, WhileNoTimePassesNothingHasAPace) {
  add({now_, kA});
  wait(kPeriod, 20);
  for (int i = 0; i < 100; ++i) {
    add({now_, kA});  // a simulation is paused, and a timer of wall time goes on
  }
  EXPECT_EQ(faster(), 0);
  const Reason reason = suspect(faster_).reason;
  EXPECT_TRUE(std::isfinite(reason.value) && std::isfinite(reason.usual)) << reason.words;
}

TEST(SeldomPaceTest, WhoseGapsTellLittleNeedsAFlood) {
  const auto countsOfSeldom = [](unsigned seed) {
    return startOf(together({timer(kA, 0, 100 * kSecond, kPeriod),
                             irregular(kC, 0, 100 * kSecond, 5 * kSecond, seed)}),
                   seed);
  };
  const Model model(watch(countsOfSeldom(1), countsOfSeldom(2)));
  EXPECT_EQ(leastOf(model, kFaster, kA), Tuning{}.least_sum);
  EXPECT_EQ(leastOf(model, kFaster, kC), Tuning{}.least_told);
}

TEST_F(PaceTest, ASumThatReachedItsCapHasNoLimit) {
  // As of a robot that sends at other rates in other modes: nobody knows how far it would grow.
  const Expectation& expected = model_->expectation(slower_);
  EXPECT_EQ(expected.limit(slower_, 199, 300), 300);
  EXPECT_TRUE(std::isnan(expected.limit(slower_, 200, 300)));
  const std::vector<Coverage::Blind> blind =
      coverageOf(*model_, allLimits(*model_, kNone), {}, kWindow, false)
          .at(model_->componentIndex(kA))
          .blind;
  ASSERT_EQ(blind.size(), 2U);
  EXPECT_EQ(blind[0].about, "slower pace");
  EXPECT_EQ(blind[1].about, "faster pace");
  EXPECT_EQ(blind[0].topic, kTypes[kA].scope);
}

TEST_F(PaceTest, AfterARestartOfTheComponentTheSumIsForgotten) {
  add({now_, kA});
  wait(kPeriod, 10);
  wait(kLong);
  EXPECT_GT(slower(), 0);
  wait(6 * kPeriod);
  EXPECT_EQ(slower(), 0) << "so long a gap is that of a restart";
  wait(kPeriod);
  wait(kLong);
  EXPECT_GT(slower(), 0) << "at once";
}

TEST_F(PaceTest, AnotherPaceIsToldForAsLongAsItLasts) {
  useLimits();
  add({now_, kA});
  wait(kPeriod, 10);
  wait(kLong, 300);
  EXPECT_GT(slower(), 0) << "two minutes later";
  EXPECT_EQ(scorer_.raisedBy(slower_), 0);
  wait(kPeriod, 60);
  EXPECT_EQ(slower(), 0);
}

TEST_F(PaceTest, ASuspectIsToldOfByTheNumberSinceTheSumBegan) {
  add({now_, kA});
  wait(kPeriod, 60);
  wait(kLong, 10);
  const Reason reason = suspect(slower_).reason;
  EXPECT_EQ(reason.kind, Kind::kSlow);
  EXPECT_EQ(reason.unit, unit::kHertz);
  EXPECT_NEAR(reason.value, 2.5, 1e-9);
  EXPECT_NEAR(reason.usual, 5, 1e-9);
  EXPECT_DOUBLE_EQ(reason.lasted, 4);
  EXPECT_EQ(reason.words, "10 in the last 4.0 s, usually 19 to 21");
  EXPECT_EQ(reason.after, "");
}

TEST(PaceOfFewGaps, NeedsMoreWhereTheyDoNotTellItFromAnotherOne) {
  const auto isTold = [](int gaps, bool regular) {
    const std::int64_t end = gaps * kSecond + 1;
    const auto start = [&](unsigned seed) {
      const Events own =
          regular ? timer(kA, 0, end, kSecond) : irregular(kA, 0, end, kSecond, seed);
      return together({own, timer(kC, 0, end, kPeriod)});
    };
    const Model model(watch(countsOf({start(1)}), countsOf({later(start(2))})));
    return leastOf(model, kSlower, kA) == Tuning{}.least_sum;
  };
  EXPECT_FALSE(isTold(static_cast<int>(Tuning{}.fewest_gaps), true));
  EXPECT_TRUE(isTold(100, true));
  EXPECT_FALSE(isTold(100, false)) << "by chance, a hundred come as seldom";
  EXPECT_TRUE(isTold(5000, false));
}

TEST(PaceOfClumps, IsToldByTheirNumber) {
  const auto least = [](std::int64_t clumps) {  // of ten messages each
    const std::int64_t end = clumps * 10 * kSecond;
    const auto start = [&](unsigned seed) {
      Events events;
      for (const Event& first : irregular(kA, 0, end, 10 * kSecond, seed)) {
        for (int i = 0; i < 10; ++i) {
          events.push_back({first.stamp + i * kShort, kA});
        }
      }
      return together({events, timer(kC, 0, end, kPeriod)});
    };
    return leastOf(Model(watch(countsOf({start(1)}), countsOf({later(start(2))}))), kFaster, kA);
  };
  EXPECT_EQ(least(30), Tuning{}.least_told) << "600 gaps, but 60 clumps";
  EXPECT_EQ(least(600), Tuning{}.least_sum);
}

}  // namespace
}  // namespace self_awareness::core::evidence
