#include "core/evidence/channel/scorer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "../recordings.h"
#include "core/evidence/count/log_bins.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kPeriod = 200 * kMillisecond;
constexpr std::int64_t kUsual = 20 * kMillisecond;
constexpr std::int64_t kUnusual = 60 * kMillisecond;
constexpr int kArming = 30;  // events

// A comes irregularly, and B kUsual after it.
Statistics followed(unsigned seed) {
  const Events asked = irregular(kA, 0, 100 * kSecond, kPeriod, seed);
  return countsOf({later(together({asked, answers(kB, asked, kUsual)}), seed * kStart)}, 2);
}

class EvidenceScorerTest : public testing::Test {
 protected:
  std::size_t track(Channel channel, EventId to, EventId from) const {
    const std::size_t index = indexOf(model_->tracks(), channel, to, from);
    EXPECT_LT(index, model_->tracks().size());
    return index;
  }
  // Adds an A, and a B so many ns later; none: no B.
  void ask(std::optional<std::int64_t> delay) {
    scorer_.add({now_, kA});
    if (delay) {
      scorer_.add({now_ + *delay, kB});
    }
    now_ += kPeriod;
  }
  void askUsually(int times) {
    for (int i = 0; i < times; ++i) {
      ask(kUsual);
    }
  }
  double evidence(std::size_t track) { return scorer_.closeWindow(now_)[track]; }

  std::shared_ptr<const Model> model_ = std::make_shared<Model>(watch(followed(1), followed(2)));
  Scorer scorer_{model_, kWindow};
  std::int64_t now_ = 1000 * kSecond;
};

TEST_F(EvidenceScorerTest, DelaysAddUpAsInACusumTest) {
  for (const auto& [channel, drift] :
       {std::pair(Channel::kDelay, 1.0), std::pair(Channel::kSlowDelay, 0.5)}) {
    const std::size_t pair = track(channel, kB, kA);
    scorer_.restart();
    askUsually(kArming);
    double sum = evidence(pair);
    EXPECT_EQ(sum, 0);  // usual delays do not let it fall below 0
    double regime = 0;  // of the last two minutes
    std::optional<std::int64_t> last;
    const auto add = [&](std::int64_t delay) {
      const std::int64_t stamp = now_ + delay;
      const double surprise = model_->surprise(pair, delay);
      sum = std::max(sum + surprise - std::max(regime, 0.0) - drift, 0.0);
      regime += (surprise - regime) * toSeconds(last ? stamp - *last : 0) / 120;
      last = stamp;
      ask(delay);
    };
    scorer_.restart();
    for (int i = 0; i < kArming; ++i) {
      add(kUsual);
    }
    for (const std::int64_t delay : {kUnusual, kUnusual, kUsual, kUnusual, kUsual, kUsual}) {
      add(delay);
      EXPECT_NEAR(evidence(pair), sum, 1e-12);
    }
    EXPECT_GT(sum, 0);
  }
}

TEST_F(EvidenceScorerTest, EvidenceIsBounded) {
  const std::size_t pair = track(Channel::kDelay, kB, kA);
  askUsually(kArming);
  for (int i = 0; i < 1000; ++i) {
    ask(kUnusual);
  }
  EXPECT_EQ(evidence(pair), 200);
  EXPECT_EQ(scorer_.cap(pair), 200);
}

TEST_F(EvidenceScorerTest, AStalePredecessorCountsOnce) {
  const std::size_t pair = track(Channel::kDelay, kB, kA);
  askUsually(kArming);
  scorer_.add({now_, kA});
  scorer_.add({now_ + kUnusual, kB});
  const double once = evidence(pair);
  EXPECT_GT(once, 0);
  for (int i = 1; i < 10; ++i) {  // B goes on without A
    scorer_.add({now_ + i * kPeriod, kB});
  }
  EXPECT_EQ(evidence(pair), once);
}

TEST_F(EvidenceScorerTest, DelaysThatNeverWereAsInTrainingSayNothing) {
  const std::size_t pair = track(Channel::kDelay, kB, kA);
  for (int i = 0; i < 10 * kArming; ++i) {
    ask(kUnusual);
  }
  EXPECT_EQ(evidence(pair), 0);
}

TEST_F(EvidenceScorerTest, DelaysCountOnceTheyWereAsInTraining) {
  const std::size_t pair = track(Channel::kDelay, kB, kA);
  for (int i = 0; i < kArming; ++i) {
    ask(kUnusual);
  }
  askUsually(2 * kArming - 1);  // after a failure it takes twice as many
  ask(kUsual);                  // armed with this one
  for (int i = 0; i < 10; ++i) {
    ask(kUnusual);
  }
  EXPECT_GT(evidence(pair), model_->leastLimit(pair));
}

TEST_F(EvidenceScorerTest, FewerEventsThanNeededDoNotArm) {
  const std::size_t pair = track(Channel::kDelay, kB, kA);
  askUsually(kArming - 2);
  ask(kUnusual);
  EXPECT_EQ(evidence(pair), 0);
  ask(kUsual);  // one unusual delay of thirty is as in training
  ask(kUnusual);
  EXPECT_GT(evidence(pair), 0);
}

TEST_F(EvidenceScorerTest, WhatWasGoneMustBeArmedAgain) {
  for (const EventId gone : {kA, kB}) {
    const std::size_t pair = track(Channel::kDelay, kB, kA);
    scorer_.restart();
    askUsually(kArming);
    ask(kUnusual);
    EXPECT_GT(evidence(pair), 0);
    const std::int64_t end = now_ + 6 * model_->longestGap(gone);
    for (; now_ < end; now_ += kPeriod) {
      scorer_.add({now_, gone == kA ? kB : kA});
    }
    for (int i = 0; i < kArming; ++i) {
      ask(kUnusual);
    }
    EXPECT_EQ(evidence(pair), 0) << gone;
    askUsually(2 * kArming);
    ask(kUnusual);
    EXPECT_GT(evidence(pair), 0) << gone;
  }
}

TEST_F(EvidenceScorerTest, APauseIsNotYetGone) {
  const std::size_t pair = track(Channel::kDelay, kB, kA);
  askUsually(kArming);
  now_ += 4 * model_->longestGap(kA);
  askUsually(1);
  ask(kUnusual);
  EXPECT_GT(evidence(pair), 0);
}

TEST_F(EvidenceScorerTest, MissedAnswersAddUpAsInACusumTest) {
  const std::size_t answer = track(Channel::kAnswer, kB, kA);
  askUsually(kArming + 1);  // the next A shows what an A got
  ask(kUsual);
  double sum = evidence(answer);
  EXPECT_EQ(sum, 0);
  bool answered = true;
  for (const bool answers : {false, false, true, false, true, true, true, true}) {
    ask(answers ? std::optional<std::int64_t>(kUsual) : std::nullopt);
    sum = std::max(sum + (answered ? model_->answered(answer) : model_->missed(answer)), 0.0);
    answered = answers;
    EXPECT_DOUBLE_EQ(evidence(answer), sum);
  }
}

TEST_F(EvidenceScorerTest, NoSumGrowsFarBeyondItsLimit) {
  const std::size_t pair = track(Channel::kDelay, kB, kA);
  Limits limits;
  limits.tracks.assign(model_->tracks().size(), 14);
  scorer_.capAt(limits);
  askUsually(kArming);
  for (int i = 0; i < 30; ++i) {
    ask(kUnusual);
  }
  EXPECT_DOUBLE_EQ(evidence(pair), 1.5 * 14);
  EXPECT_DOUBLE_EQ(scorer_.cap(pair), 1.5 * 14);
}

TEST_F(EvidenceScorerTest, AnswersThatNeverCameAsInTrainingSayNothing) {
  const std::size_t answer = track(Channel::kAnswer, kB, kA);
  for (int i = 0; i < 10 * kArming; ++i) {
    ask(i % 2 == 0 ? std::optional<std::int64_t>(kUsual) : std::nullopt);
  }
  EXPECT_EQ(evidence(answer), 0);
  askUsually(8 * kArming);  // after three failures
  ask(std::nullopt);
  ask(std::nullopt);
  EXPECT_GT(evidence(answer), 0);
}

TEST_F(EvidenceScorerTest, ATypeThatWasNeverSeenIsNotMissed) {
  const std::size_t answer = track(Channel::kAnswer, kB, kA);
  for (int i = 0; i < 10 * kArming; ++i) {
    ask(std::nullopt);
  }
  askUsually(kArming + 1);
  EXPECT_EQ(evidence(answer), 0);
  ask(std::nullopt);  // armed by now
  ask(std::nullopt);
  EXPECT_GT(evidence(answer), 0);
}

TEST_F(EvidenceScorerTest, OverdueGoesByTheTimeSinceTheLastOne) {
  const std::size_t overdue = track(Channel::kOverdue, kA, kA);
  EXPECT_EQ(scorer_.closeWindow(now_)[overdue], 0);  // never seen since the start
  scorer_.add({now_, kA});
  for (const std::int64_t age : {kMillisecond, kSecond, 100 * kSecond}) {
    scorer_.add({now_ + age, kB});  // the robot is not silent
    EXPECT_EQ(scorer_.closeWindow(now_ + age)[overdue], model_->overdue(kA, age));
    EXPECT_EQ(scorer_.windowEnd(), now_ + age);
  }
  EXPECT_EQ(scorer_.lastSeen(kA), now_);
  scorer_.restart();
  scorer_.add({now_, kA});
  EXPECT_EQ(scorer_.lastSeen(kB), std::nullopt);
}

TEST_F(EvidenceScorerTest, RatesAreJudgedOnceTheSpanIsFull) {
  const std::size_t fewer = track(Channel::kFewer, kA, kA);
  const std::size_t more = track(Channel::kMore, kA, kA);
  const std::size_t unseen = track(Channel::kFewer, kB, kB);
  for (int window = 1; window <= 40; ++window) {
    for (int i = 0; i < (window <= 20 ? 10 : 0); ++i) {
      scorer_.add({now_, kA});
    }
    const std::vector<double>& evidence = scorer_.closeWindow(now_ += kWindow);
    EXPECT_EQ(evidence[unseen], 0);
    if (window < 20) {
      EXPECT_EQ(evidence[more], 0) << window;
    } else if (window == 20) {
      EXPECT_EQ(scorer_.recentCount(kA), 200U);
      EXPECT_EQ(evidence[more], model_->rate(kA, 200));
      EXPECT_GT(evidence[more], 3);
      EXPECT_EQ(evidence[fewer], 0);
    }
  }
  const std::vector<double>& evidence = scorer_.closeWindow(now_);
  EXPECT_EQ(evidence[fewer], -model_->rate(kA, 0));
  EXPECT_GT(evidence[fewer], 0);
  EXPECT_EQ(evidence[more], 0);
}

TEST_F(EvidenceScorerTest, UnknownEventsAreLeftOut) {
  EXPECT_EQ(scorer_.add({now_, kC}), std::nullopt);
  EXPECT_EQ(scorer_.add({now_ + 1, kC}), std::nullopt);
  for (const double evidence : scorer_.closeWindow(now_ + kSecond)) {
    EXPECT_EQ(evidence, 0);
  }
}

TEST_F(EvidenceScorerTest, ReturnsTheGapOfTheType) {
  EXPECT_EQ(scorer_.add({now_, kA}), std::nullopt);
  EXPECT_EQ(scorer_.add({now_ + 5, kB}), std::nullopt);
  EXPECT_EQ(scorer_.add({now_ + 7, kA}), 7);
}

TEST_F(EvidenceScorerTest, ARestartForgetsAll) {
  askUsually(kArming);
  ask(kUnusual);
  scorer_.restart();
  for (const double evidence : scorer_.closeWindow(now_ + 100 * kSecond)) {
    EXPECT_EQ(evidence, 0);
  }
  EXPECT_EQ(scorer_.lastSeen(kA), std::nullopt);
}

TEST_F(EvidenceScorerTest, TheLinkerAddsUpTheLargestShareOfEveryEventType) {
  const std::vector<Track>& tracks = model_->tracks();
  Limits limits;
  limits.tracks.assign(tracks.size(), 10);
  std::vector<double> evidence(tracks.size(), 0);
  evidence[track(Channel::kOverdue, kA, kA)] = 7;
  evidence[track(Channel::kDelay, kB, kA)] = 8;
  evidence[track(Channel::kSlowDelay, kB, kA)] = 30;  // at most 1
  evidence[track(Channel::kAnswer, kB, kA)] = 8;      // less than that
  evidence[track(Channel::kSlowDelay, kA, kA)] = 6;   // half of a limit says nothing
  Sum sum = sumUp(evidence, *model_, limits);
  EXPECT_DOUBLE_EQ(sum.largest, 0.8);
  EXPECT_DOUBLE_EQ(sum.linker, 1.2);
  evidence[track(Channel::kSlowDelay, kA, kA)] = 5;
  EXPECT_DOUBLE_EQ(sumUp(evidence, *model_, limits).linker, 1);

  limits.tracks[track(Channel::kDelay, kB, kA)] = std::numeric_limits<double>::quiet_NaN();
  limits.tracks[track(Channel::kSlowDelay, kB, kA)] = std::numeric_limits<double>::quiet_NaN();
  sum = sumUp(evidence, *model_, limits);
  EXPECT_DOUBLE_EQ(sum.largest, 0.8);
  EXPECT_DOUBLE_EQ(sum.linker, 0.6);
}

}  // namespace
}  // namespace self_awareness::core::evidence
