#include "core/evidence/blame/hindsight.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "../recordings.h"
#include "core/evidence/channel/scorer.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kPeriod = 200 * kMillisecond;
constexpr std::int64_t kUsual = 20 * kMillisecond;
constexpr std::int64_t kLate = 62 * kMillisecond;
constexpr std::int64_t kEarly = 3 * kMillisecond;
constexpr double kCap = 30;

// A comes irregularly, and B kUsual after it.
Statistics followed(unsigned seed) {
  const Events asked = irregular(kA, 0, 100 * kSecond, kPeriod, seed);
  return countsOf({later(together({asked, answers(kB, asked, kUsual)}), seed * kStart)}, 2);
}

class HindsightTest : public testing::Test {
 protected:
  // Adds an A, and a B so many ns later; none: no B.
  void ask(std::optional<std::int64_t> delay) {
    hindsight_.add({now_, kA});
    if (delay) {
      hindsight_.add({now_ + *delay, kB});
    }
    now_ += kPeriod;
  }
  void askUsually(int times) {
    for (int i = 0; i < times; ++i) {
      ask(kUsual);
    }
  }
  Hindsight::Delays delays() const {
    return hindsight_.delays(indexOf(model_->tracks(), Channel::kDelay, kB, kA), kCap).value();
  }
  std::optional<Hindsight::Answers> answers() const {
    return hindsight_.answers(indexOf(model_->tracks(), Channel::kAnswer, kB, kA), kCap);
  }

  std::shared_ptr<const Model> model_ = std::make_shared<Model>(watch(followed(1), followed(2)));
  Hindsight hindsight_{model_};
  std::int64_t now_ = 1000 * kSecond;
};

TEST_F(HindsightTest, SeesTheDelaysSinceTheSumWasZero) {
  askUsually(50);
  const std::int64_t first = now_ + kLate;
  for (int i = 0; i < 6; ++i) {
    ask(kLate + i * kMillisecond / 10);
  }
  ask(kUsual);
  const Hindsight::Delays found = delays();
  EXPECT_EQ(found.since, first);
  EXPECT_EQ(found.number, 7U);
  EXPECT_EQ(found.unusual, 6U);
  EXPECT_EQ(found.usual, kUsual);
  EXPECT_EQ(found.delay, kLate + 3 * kMillisecond / 10) << "the median of six";
  EXPECT_FALSE(found.scatter);
}

TEST_F(HindsightTest, WhatIsUsualIsWhatCameBeforeInTheSameRecording) {
  for (int i = 0; i < 50; ++i) {
    ask(kUsual + kMillisecond);
  }
  ask(kLate);
  EXPECT_EQ(delays().usual, kUsual + kMillisecond);
  hindsight_.restart();
  askUsually(3);  // too few
  ask(kLate);
  EXPECT_NEAR(delays().usual, model_->usualDelay(kA, kB, 0.5) * 1e9, 1);
}

TEST_F(HindsightTest, UnusualDelaysThatPassedAreForgotten) {
  askUsually(50);
  for (int i = 0; i < 100; ++i) {
    ask(kLate);
  }
  askUsually(50);  // enough to come down from the cap
  ask(kEarly);
  const Hindsight::Delays found = delays();
  EXPECT_EQ(found.number, 1U);
  EXPECT_EQ(found.delay, kEarly);
}

TEST_F(HindsightTest, WithoutUnusualDelaysItSeesTheLastOne) {
  EXPECT_FALSE(hindsight_.delays(indexOf(model_->tracks(), Channel::kDelay, kB, kA), kCap));
  hindsight_.add({now_, kB});  // after no A
  EXPECT_FALSE(hindsight_.delays(indexOf(model_->tracks(), Channel::kDelay, kB, kA), kCap));
  askUsually(10);
  EXPECT_EQ(delays().number, 1U);
  EXPECT_EQ(delays().unusual, 0U);
  EXPECT_EQ(delays().delay, kUsual);
}

TEST_F(HindsightTest, AStalePredecessorCountsOnce) {
  askUsually(20);
  hindsight_.add({now_, kA});
  hindsight_.add({now_ + kLate, kB});
  for (int i = 1; i < 10; ++i) {  // B goes on without A
    hindsight_.add({now_ + i * kPeriod, kB});
  }
  EXPECT_EQ(delays().number, 1U);
  EXPECT_EQ(delays().delay, kLate);
}

TEST_F(HindsightTest, DelaysOnBothSidesAreScattered) {
  askUsually(50);
  for (int i = 0; i < 10; ++i) {
    ask(i % 2 == 0 ? kEarly : kLate);
  }
  EXPECT_EQ(delays().unusual, 10U);
  EXPECT_GE(delays().scatter.value(), kUsual - kEarly);
  EXPECT_LE(delays().scatter.value(), kLate - kUsual);
  for (int i = 0; i < 40; ++i) {
    ask(kLate);
  }
  EXPECT_FALSE(delays().scatter) << "nearly all of them are late";
}

TEST_F(HindsightTest, SeesTheGapsOfAType) {
  const auto gaps = [&] {
    return hindsight_.delays(indexOf(model_->tracks(), Channel::kDelay, kA, kA), kCap);
  };
  ASSERT_TRUE(isWatched(model_->tracks(), Channel::kDelay, kA, kA));
  hindsight_.add({now_, kA});
  EXPECT_FALSE(gaps());
  hindsight_.add({now_ + kPeriod, kA});
  EXPECT_EQ(gaps().value().delay, kPeriod);
}

TEST_F(HindsightTest, SeesTheAnswersSinceTheSumWasZero) {
  askUsually(50);
  EXPECT_FALSE(answers());
  const std::int64_t first = now_;
  for (const bool answered : {false, false, true, false, true}) {
    ask(answered ? std::optional<std::int64_t>(kUsual) : std::nullopt);
  }
  ask(kUsual);  // the next A shows what an A got
  const Hindsight::Answers found = answers().value();
  EXPECT_EQ(found.since, first);
  EXPECT_EQ(found.asked, 5U);
  EXPECT_EQ(found.missed, 3U);
  askUsually(50);
  EXPECT_FALSE(answers());
}

TEST_F(HindsightTest, ABurstIsOneQuestionAndWhatComesBackWasNotMissed) {
  askUsually(50);
  for (const bool answered : {false, true}) {
    for (int i = 0; i < 20; ++i) {
      hindsight_.add({now_ + i * 1000, kA});
    }
    if (answered) {
      hindsight_.add({now_ + kUsual, kB});
      hindsight_.add({now_ + kUsual + 1000, kB});
    }
    now_ += kPeriod;
    hindsight_.add({now_, kA});
    if (answered) {
      EXPECT_FALSE(answers()) << "the one that was missing has come";
    } else {
      EXPECT_EQ(answers().value().asked, 1U);
      EXPECT_EQ(answers().value().missed, 1U);
    }
    now_ += kUsual / 2;  // too soon for another question
  }
}

TEST_F(HindsightTest, TheSumsAreThoseOfTheScorer) {
  Scorer scorer(model_, kWindow);
  const auto add = [&](const Event& event) {
    scorer.add(event);
    hindsight_.add(event);
  };
  const std::size_t pair = indexOf(model_->tracks(), Channel::kDelay, kB, kA);
  const std::size_t answer = indexOf(model_->tracks(), Channel::kAnswer, kB, kA);
  std::mt19937 random(1);
  int pairs = 0;
  int misses = 0;
  for (int i = 0; i < 2000; ++i) {
    add({now_, kA});
    if (i < 40 || random() % 8 != 0) {
      add({now_ + (i < 40 || random() % 8 != 0 ? kUsual : kLate), kB});
    }
    now_ += kPeriod;
    const std::vector<double>& evidence = scorer.closeWindow(now_);
    EXPECT_EQ(hindsight_.answers(answer, scorer.cap(answer)).has_value(), evidence[answer] > 0);
    EXPECT_EQ(hindsight_.delays(pair, scorer.cap(pair))->unusual > 0, evidence[pair] > 0);
    pairs += evidence[pair] > 0 ? 1 : 0;
    misses += evidence[answer] > 0 ? 1 : 0;
  }
  EXPECT_GT(pairs, 100);
  EXPECT_LT(pairs, 1900);
  EXPECT_GT(misses, 100);
  EXPECT_LT(misses, 1900);
}

TEST_F(HindsightTest, RemembersTheLastEventsOnly) {
  askUsually(100);
  for (std::size_t i = 0; i < Hindsight::kMostEvents + 100; ++i) {
    ask(std::nullopt);
  }
  EXPECT_EQ(answers().value().asked, Hindsight::kMostEvents - 1);
  for (std::size_t i = 0; i < Hindsight::kMostEvents; ++i) {
    hindsight_.add({now_, kC});  // the model does not know it
  }
  EXPECT_EQ(answers().value().asked, Hindsight::kMostEvents - 1);
  askUsually(2 * static_cast<int>(Hindsight::kMostEvents));
  EXPECT_FALSE(answers());
}

TEST_F(HindsightTest, WhatHasBeenLateForMinutesIsTheRegime) {
  askUsually(50);
  for (int i = 0; i < 20; ++i) {
    ask(kLate);
  }
  EXPECT_EQ(delays().unusual, 20U);
  for (int i = 0; i < 3000; ++i) {  // ten minutes
    ask(kLate);
  }
  EXPECT_EQ(delays().unusual, 0U);
}

}  // namespace
}  // namespace self_awareness::core::evidence
