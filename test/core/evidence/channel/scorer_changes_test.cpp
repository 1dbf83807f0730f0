// What changes and stays so: arming, acceptance, and the regime that delays are relative to.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "../recordings.h"
#include "core/evidence/channel/scorer.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kPeriod = 200 * kMillisecond;
constexpr std::int64_t kUsual = 20 * kMillisecond;
constexpr std::int64_t kUnusual = 60 * kMillisecond;
constexpr int kArming = 30;  // events
constexpr double kLimit = 14;
constexpr std::int64_t kAccepted = 60 * kSecond;

// A comes irregularly, and B kUsual after it.
Statistics followed(unsigned seed) {
  const Events asked = irregular(kA, 0, 100 * kSecond, kPeriod, seed);
  return countsOf({later(together({asked, answers(kB, asked, kUsual)}), seed * kStart)}, 2);
}

class ScorerChangesTest : public testing::Test {
 protected:
  std::size_t track(Channel channel, EventId to, EventId from) const {
    const std::size_t index = indexOf(model_->tracks(), channel, to, from);
    EXPECT_LT(index, model_->tracks().size());
    return index;
  }
  // Adds an A, and a B so many ns later; none: no B. Closes a window.
  void ask(std::optional<std::int64_t> delay) {
    scorer_.add({now_, kA});
    if (delay) {
      scorer_.add({now_ + *delay, kB});
    }
    now_ += kPeriod;
    evidence_ = scorer_.closeWindow(now_);
  }
  void askUsually(int times) {
    for (int i = 0; i < times; ++i) {
      ask(kUsual);
    }
  }
  void useLimits() {
    Limits limits;
    limits.tracks.assign(model_->tracks().size(), kLimit);
    scorer_.capAt(limits);
  }
  // Asks for so long, and returns for how long the evidence of a track was above the limit [ns].
  template <typename Delay>
  std::int64_t abnormalFor(std::size_t track, std::int64_t length, Delay delay) {
    std::int64_t abnormal = 0;
    int number = 0;
    for (const std::int64_t end = now_ + length; now_ < end;) {
      ask(delay(number++));
      abnormal += evidence_[track] > kLimit ? kPeriod : 0;
    }
    return abnormal;
  }

  std::shared_ptr<const Model> model_ = std::make_shared<Model>(watch(followed(1), followed(2)));
  Scorer scorer_{model_, kWindow};
  std::vector<double> evidence_;
  std::int64_t now_ = 10 * kStart;
  std::size_t pair_ = track(Channel::kDelay, kB, kA);
  std::size_t answer_ = track(Channel::kAnswer, kB, kA);
};

const auto kAlwaysLate = [](int) { return std::optional<std::int64_t>(kUnusual); };
const auto kNever = [](int) { return std::optional<std::int64_t>(); };
const auto kEverySecond = [](int number) {
  return number % 2 == 0 ? std::optional<std::int64_t>() : std::optional<std::int64_t>(kUsual);
};

TEST_F(ScorerChangesTest, EveryFailureToArmDoublesTheEventsThatItTakes) {
  useLimits();
  for (int failures = 0; failures < 4; ++failures) {
    scorer_.restart();
    for (int failed = 0; failed < failures; ++failed) {
      for (int i = 0; i < kArming << failed; ++i) {
        ask(kUnusual);
      }
    }
    askUsually((kArming << failures) - 2);
    ask(kUnusual);
    EXPECT_EQ(evidence_[pair_], 0) << failures;
    ask(kUsual);  // armed with this one
    ask(kUnusual);
    EXPECT_GT(evidence_[pair_], 0) << failures;
  }
}

TEST_F(ScorerChangesTest, LateAnswersAreNewsOnceAndThenAccepted) {
  useLimits();
  askUsually(kArming);
  const std::int64_t abnormal = abnormalFor(pair_, 10 * kAccepted, kAlwaysLate);
  EXPECT_GE(abnormal, kAccepted);
  EXPECT_LT(abnormal, kAccepted + kSecond);
  EXPECT_EQ(evidence_[pair_], 0);
}

TEST_F(ScorerChangesTest, WhatWasAcceptedIsHarderToArmAgain) {
  useLimits();
  askUsually(kArming);
  abnormalFor(pair_, kAccepted + 5 * kPeriod, kAlwaysLate);
  ASSERT_EQ(evidence_[pair_], 0);
  scorer_.restart();
  askUsually(kArming);
  std::int64_t accepted_at = 0;
  for (; evidence_[pair_] <= kLimit;) {
    ask(kUnusual);
  }
  for (; evidence_[pair_] > 0;) {
    ask(kUnusual);
    accepted_at = now_;
  }
  EXPECT_GT(accepted_at, 0);
  askUsually(kArming + 2);
  ask(kUnusual);
  EXPECT_EQ(evidence_[pair_], 0) << "as many as at the start are not enough";
  askUsually(kArming);
  ask(kUnusual);
  EXPECT_GT(evidence_[pair_], 0);
}

TEST_F(ScorerChangesTest, NothingIsAcceptedWhileLimitsAreNotKnown) {
  askUsually(kArming);
  abnormalFor(pair_, 2 * kAccepted, kAlwaysLate);
  EXPECT_GT(evidence_[pair_], kLimit);
}

TEST_F(ScorerChangesTest, WhatIsUsualAgainInBetweenIsNewsAgain) {
  useLimits();
  askUsually(kArming);
  std::int64_t abnormal = 0;
  for (int times = 0; times < 3; ++times) {
    abnormal += abnormalFor(pair_, kAccepted * 2 / 3, kAlwaysLate);
    EXPECT_GT(evidence_[pair_], kLimit) << times;
    askUsually(100);
    EXPECT_EQ(evidence_[pair_], 0) << times;
  }
  EXPECT_GT(abnormal, kAccepted * 3 / 2);
}

TEST_F(ScorerChangesTest, FewerAnswersAreAccepted) {
  useLimits();
  askUsually(kArming + 2);
  const std::int64_t abnormal = abnormalFor(answer_, 5 * kAccepted, kEverySecond);
  EXPECT_GE(abnormal, kAccepted);
  EXPECT_LT(abnormal, kAccepted + 5 * kSecond);
}

TEST_F(ScorerChangesTest, NoAnswersAtAllAreNeverAccepted) {
  useLimits();
  askUsually(kArming + 2);
  const std::int64_t length = 5 * kAccepted;
  EXPECT_GT(abnormalFor(answer_, length, kNever), length - 10 * kSecond);
  EXPECT_GT(evidence_[answer_], kLimit);
}

TEST_F(ScorerChangesTest, ALoadThatStaysIsTheNewUsual) {
  // Every fourth answer is late: for some minutes that is evidence, then it is the regime.
  const auto loaded = [](int number) {
    return std::optional<std::int64_t>(number % 4 == 0 ? kUnusual : kUsual);
  };
  askUsually(kArming);
  EXPECT_GT(abnormalFor(pair_, 100 * kSecond, loaded), 0);
  abnormalFor(pair_, 1000 * kSecond, loaded);
  EXPECT_LT(abnormalFor(pair_, 300 * kSecond, loaded), kSecond);
  // What is worse than that is still found.
  for (int i = 0; i < 10; ++i) {
    ask(kUnusual);
  }
  EXPECT_GT(evidence_[pair_], kLimit);
}

}  // namespace
}  // namespace self_awareness::core::evidence
