// Answers and deadlines: what somebody asks for comes, comes late, or does not come.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "../recordings.h"
#include "core/evidence/channel/scorer.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kPeriod = 200 * kMillisecond;
constexpr std::int64_t kUsual = 20 * kMillisecond;

// A comes irregularly, and B after it, in two starts.
std::shared_ptr<const Model> modelOf(std::int64_t length, std::int64_t gap, std::int64_t delay) {
  const auto start = [&](unsigned seed) {
    const Events asked = irregular(kA, 0, length, gap, seed);
    return countsOf({later(together({asked, answers(kB, asked, delay)}), seed * 10 * kStart)}, 2);
  };
  return std::make_shared<Model>(watch(start(1), start(2)));
}

class ScorerAnswersTest : public testing::Test {
 protected:
  ScorerAnswersTest() {
    for (int i = 0; i < 40; ++i) {
      ask(1);
    }
    EXPECT_EQ(evidence(), 0);
  }
  // Adds an A, and so many B after it.
  void ask(int answers) {
    scorer_.add({now_, kA});
    for (int i = 0; i < answers; ++i) {
      scorer_.add({now_ + kUsual + i * 10 * kMillisecond, kB});
    }
    now_ += kPeriod;
  }
  double evidence() { return scorer_.closeWindow(now_)[answer_]; }

  std::shared_ptr<const Model> model_ = modelOf(100 * kSecond, kPeriod, kUsual);
  std::size_t answer_ = indexOf(model_->tracks(), Channel::kAnswer, kB, kA);
  Scorer scorer_{model_, kWindow};
  std::int64_t now_ = 5 * kStart;
};

TEST_F(ScorerAnswersTest, ABurstIsOneQuestion) {
  const auto burst = [&](bool answered) {
    for (int i = 0; i < 20; ++i) {
      scorer_.add({now_ + i * 2000, kA});
    }
    if (answered) {
      scorer_.add({now_ + kUsual, kB});
    }
    now_ += kPeriod;
  };
  for (int i = 0; i < 20; ++i) {
    burst(true);
    EXPECT_EQ(evidence(), 0);
  }
  burst(false);
  ask(1);  // now it is known that no answer came
  EXPECT_DOUBLE_EQ(evidence(), model_->missed(answer_));
}

TEST_F(ScorerAnswersTest, PhasesThatCrossLeaveNothingOut) {
  for (int i = 0; i < 200; ++i) {
    ask(i % 2 == 0 ? 0 : 2);
    EXPECT_LE(evidence(), model_->missed(answer_));
  }
}

TEST_F(ScorerAnswersTest, AnswersThatComeBackWereOnlyLate) {
  for (const int answers : {0, 0, 0, 4}) {
    ask(answers);
  }
  EXPECT_DOUBLE_EQ(evidence(), 3 * model_->missed(answer_));
  ask(1);
  EXPECT_EQ(evidence(), 0);
}

TEST_F(ScorerAnswersTest, AnswersThatDoNotComeBackAreMissing) {
  for (const int answers : {0, 0, 0, 1, 1}) {
    ask(answers);
  }
  const double missed = 3 * model_->missed(answer_) + model_->answered(answer_);
  EXPECT_NEAR(evidence(), missed, 1e-12);
}

TEST_F(ScorerAnswersTest, MoreAnswersThanWereAskedForAreNoCredit) {
  for (int i = 0; i < 50; ++i) {
    ask(3);
  }
  ask(0);
  ask(0);
  ask(1);
  EXPECT_NEAR(evidence(), 2 * model_->missed(answer_), 1e-12);
}

class ScorerDeadlinesTest : public testing::Test {
 protected:
  // Requests at random with a mean gap; each is answered after a tenth of it.
  void learn(std::int64_t gap) {
    model_ = modelOf(200 * gap, gap, gap / 10);
    deadline_ = indexOf(model_->tracks(), Channel::kDeadline, kB, kA);
    ASSERT_LT(deadline_, model_->tracks().size());
    scorer_ = std::make_unique<Scorer>(model_, kWindow);
  }
  double evidenceAt(std::int64_t stamp) { return scorer_->closeWindow(stamp)[deadline_]; }

  std::shared_ptr<const Model> model_;
  std::size_t deadline_ = 0;
  std::unique_ptr<Scorer> scorer_;
};

TEST_F(ScorerDeadlinesTest, RareRequestsAreCountedInSecondsSinceTheFirst) {
  learn(8 * kSecond);
  ASSERT_FALSE(model_->countsRequests(deadline_));
  scorer_->add({0, kA});
  EXPECT_EQ(evidenceAt(20 * kSecond), 0) << "no B has been seen since the start";
  scorer_->add({20 * kSecond, kB});
  EXPECT_EQ(evidenceAt(21 * kSecond), 0);
  scorer_->add({30 * kSecond, kA});
  EXPECT_DOUBLE_EQ(evidenceAt(31 * kSecond), 1);
  scorer_->add({35 * kSecond, kA});
  EXPECT_DOUBLE_EQ(evidenceAt(36 * kSecond), 6) << "since the first one without an answer";
  EXPECT_DOUBLE_EQ(scorer_->waiting(deadline_), 6);
  EXPECT_DOUBLE_EQ(evidenceAt(50 * kSecond), 20) << "judged on a timer, not at the next request";
  scorer_->add({50 * kSecond, kB});
  EXPECT_EQ(evidenceAt(60 * kSecond), 0);
  EXPECT_EQ(scorer_->waiting(deadline_), 0);
}

TEST_F(ScorerDeadlinesTest, WhoWasNeverHeardMayBeStartingForAMinute) {
  learn(8 * kSecond);
  scorer_->add({5 * kSecond, kA});
  EXPECT_EQ(evidenceAt(60 * kSecond), 0);
  EXPECT_DOUBLE_EQ(evidenceAt(65 * kSecond), 60);
  scorer_->restart();
  scorer_->add({100 * kSecond, kA});
  EXPECT_EQ(evidenceAt(150 * kSecond), 0);
}

TEST_F(ScorerDeadlinesTest, SeriesOfRequestsAreCounted) {
  learn(500 * kMillisecond);
  ASSERT_TRUE(model_->countsRequests(deadline_));
  scorer_->add({0, kA});
  scorer_->add({50 * kMillisecond, kB});
  for (int k = 1; k <= 10; ++k) {
    EXPECT_EQ(evidenceAt(k * kSecond), k - 1);
    scorer_->add({k * kSecond, kA});
  }
  EXPECT_EQ(evidenceAt(100 * kSecond), 10) << "time alone is no request";
  scorer_->add({100 * kSecond, kB});
  EXPECT_EQ(evidenceAt(101 * kSecond), 0);
}

TEST_F(ScorerDeadlinesTest, ARestartForgetsRequests) {
  learn(8 * kSecond);
  scorer_->add({0, kB});
  scorer_->add({kSecond, kA});
  EXPECT_GT(evidenceAt(10 * kSecond), 0);
  scorer_->restart();
  scorer_->add({20 * kSecond, kB});
  EXPECT_EQ(evidenceAt(30 * kSecond), 0);
}

}  // namespace
}  // namespace self_awareness::core::evidence
