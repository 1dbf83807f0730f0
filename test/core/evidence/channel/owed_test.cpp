#include "core/evidence/channel/owed.h"

#include <gtest/gtest.h>

#include "channel_case.h"
#include "core/evidence/channel/sum.h"

namespace self_awareness::core::evidence {
namespace {

Events fourOfFive(const Events& asked) {
  std::size_t number = 0;
  return without(asked, [&](const Event&) { return number++ % 5 == 0; });
}

class OwedTest : public TrackTest {
 protected:
  // Requests of A at random with a mean gap; each is answered by B after a tenth of it.
  void learn(std::int64_t gap) {
    learn([&](unsigned seed) {
      const Events asked = irregular(kA, 0, 200 * gap, gap, seed);
      return together({asked, answers(kB, asked, gap / 10)});
    });
  }
  // @param start the events of one, by its seed
  template <typename Start>
  void learn(const Start& start) {
    TrackTest::learn(watch(startOf(start(1), 10), startOf(start(2), 20)), kDeadlines, kB, kA);
    ASSERT_LT(track_, model_->tracks().size());
  }
};

TEST_F(OwedTest, RareRequestsAreCountedInSecondsSinceTheFirst) {
  learn(8 * kSecond);
  scorer_->add({0, kA});
  EXPECT_EQ(evidenceAt(20 * kSecond), 0) << "no B has been seen since the start";
  scorer_->add({20 * kSecond, kB});
  EXPECT_EQ(evidenceAt(21 * kSecond), 0);
  scorer_->add({30 * kSecond, kA});
  EXPECT_DOUBLE_EQ(evidenceAt(31 * kSecond), 1);
  scorer_->add({35 * kSecond, kA});
  EXPECT_DOUBLE_EQ(evidenceAt(36 * kSecond), 6) << "since the first one without an answer";
  EXPECT_EQ(reason().kind, Kind::kSilent);
  EXPECT_DOUBLE_EQ(reason().value, 6);
  EXPECT_DOUBLE_EQ(reason().silence, 16) << "since the last B";
  EXPECT_EQ(reason().words, "has not come for 6.00 s after /a /x T");
  EXPECT_DOUBLE_EQ(evidenceAt(50 * kSecond), 20) << "judged on a timer, not at the next request";
  scorer_->add({50 * kSecond, kB});
  EXPECT_EQ(evidenceAt(60 * kSecond), 0);
  EXPECT_EQ(reason().value, 0);
  scorer_->restart();
  scorer_->add({2000 * kSecond, kA});
  EXPECT_EQ(evidenceAt(3000 * kSecond), 0) << "who was never heard owes nothing";
}

TEST_F(OwedTest, AGoalThatFailsIsAnAnswer) {
  const std::vector<EventType> types{
      kTypes[kA], {"/b", "/y", "T[status=3]"}, {"/b", "/y", "T[status=4]"}};
  constexpr EventId kFailed = 2;
  const auto start = [&](unsigned seed) {
    const Events asked = irregular(kA, 0, 1600 * kSecond, 8 * kSecond, seed);
    Events results = answers(kB, asked, 800 * kMillisecond);
    for (std::size_t k = 0; k < results.size(); k += 100) {
      results[k].id = kFailed;
    }
    return countsOf({later(together({asked, results}), seed * kStart)}, types);
  };
  TrackTest::learn(watch(start(10), start(20)), kDeadlines, kB, kA);
  ASSERT_LT(track_, model_->tracks().size());
  scorer_->add({0, kB});
  scorer_->add({30 * kSecond, kA});
  EXPECT_GT(evidenceAt(35 * kSecond), 0);
  scorer_->add({36 * kSecond, kFailed});
  EXPECT_EQ(evidenceAt(40 * kSecond), 0);
}

TEST_F(OwedTest, ThatAnAnswerComesAfterAllIsNewsOnce) {
  learn(8 * kSecond);
  scorer_->capAt(allLimits(*model_, 5));
  std::int64_t now = 0;
  scorer_->add({now, kB});
  const auto ask = [&](std::int64_t wait) {
    scorer_->add({now += 10 * kSecond, kA});
    double most = 0;
    for (const std::int64_t end = now + wait; now < end; now += kWindow) {
      most = std::max(most, evidenceAt(now));
    }
    scorer_->add({now, kB});
    evidenceAt(now += kWindow);
    return most;
  };
  const std::int64_t gone =
      static_cast<std::int64_t>(model_->tuning().gone_gaps + 1) * model_->longestGap(kB);
  EXPECT_GT(ask(gone), 5);
  EXPECT_GT(ask(8 * kSecond), 5) << "it was gone and came back: that says nothing of answers";
  EXPECT_EQ(scorer_->raisedBy(track_), kUnlimited) << "answers may take so long";
  for (int k = 0; k < 2 * kArming; ++k) {
    EXPECT_EQ(ask(kSecond), 0);
  }
  EXPECT_GT(ask(8 * kSecond), 5) << "it answers as in training again";
  for (int k = 0; k < 2 * kArming; ++k) {
    EXPECT_EQ(ask(kSecond), 0);
  }
  EXPECT_EQ(ask(8 * kSecond), 0) << "the next time, it takes twice as many answers";
}

TEST_F(OwedTest, SeriesOfRequestsWithoutAnAnswerAddUp) {
  learn(500 * kMillisecond);
  scorer_->add({0, kA});
  scorer_->add({50 * kMillisecond, kB});
  const double step =
      model_->tuning().least_sum / 2;  // none of 400 requests was without an answer
  for (int k = 1; k <= 10; ++k) {
    EXPECT_DOUBLE_EQ(evidenceAt(k * kSecond), step * std::max(k - 2, 0)) << "the last one is open";
    scorer_->add({k * kSecond, kA});
  }
  EXPECT_DOUBLE_EQ(evidenceAt(100 * kSecond), 9 * step) << "time alone is no request";
  EXPECT_EQ(reason().value, 10);
  EXPECT_EQ(reason().unit, unit::kRequests);
  EXPECT_EQ(reason().words, "has not come after the last 10 /a /x T");
  scorer_->add({100 * kSecond, kB});
  EXPECT_DOUBLE_EQ(evidenceAt(101 * kSecond), 9 * step - kStepOfUsual);
}

TEST_F(OwedTest, RequestsWithoutAnAnswerNowAndThenAddUp) {
  learn(500 * kMillisecond);
  scorer_->add({0, kB});
  // Two of three have no answer.
  for (int k = 1; k <= 12; ++k) {
    scorer_->add({k * kSecond, kA});
    if (k % 3 == 0) {
      scorer_->add({k * kSecond + 50 * kMillisecond, kB});
    }
  }
  EXPECT_GT(evidenceAt(13 * kSecond), 3 * model_->tuning().least_sum);
  EXPECT_EQ(reason().words, "has not come after 8 of the last 12 /a /x T");
}

TEST_F(OwedTest, AnAnswerThatComesAfterTheNextRequestIsNotMissing) {
  // The phases cross: now none comes between two requests, now two.
  learn(500 * kMillisecond);
  scorer_->add({0, kB});
  for (int k = 1; k <= 40; ++k) {
    scorer_->add({k * kSecond, kA});
    if (k % 2 == 0) {
      scorer_->add({k * kSecond + 50 * kMillisecond, kB});
      scorer_->add({k * kSecond + 950 * kMillisecond, kB});
    }
    EXPECT_LT(evidenceAt(k * kSecond + 990 * kMillisecond), model_->tuning().least_sum);
  }
}

TEST_F(OwedTest, RequestsThatStayWithoutAnAnswerNowAndThenAreCounted) {
  constexpr std::int64_t kGap = 8 * kSecond;
  const auto asked = [](unsigned seed) { return irregular(kA, 0, 400 * kGap, kGap, seed); };
  learn([&](unsigned seed) {
    return together({asked(seed), answers(kB, fourOfFive(asked(seed)), kGap / 10)});
  });
  EXPECT_EQ(model_->leastLimit(track_), model_->tuning().least_sum);
  // B answers always, and C four times of five.
  learn([&](unsigned seed) {
    return together({asked(seed), answers(kB, asked(seed), kGap / 10),
                     answers(kC, fourOfFive(asked(seed)), kGap / 8)});
  });
  ASSERT_LT(indexOf(model_->tracks(), kDeadlines, kC, kA), model_->tracks().size());
  EXPECT_EQ(model_->leastLimit(track_), model_->tuning().least_sum);
  // A request that the next one overtakes is none without an answer.
  learn([&](unsigned seed) {
    return together({asked(seed), answers(kB, asked(seed), kGap * 3 / 10)});
  });
  EXPECT_GT(missRate(model_->statistics().type(kA).gaps, model_->statistics().answers(kA, kB)),
            model_->tuning().rare);
  EXPECT_DOUBLE_EQ(model_->leastLimit(track_),
                   model_->tuning().margin_of_waiting * 1e-9 * model_->usualDelay(kA, kB, 0.95))
      << "in seconds: what usual answers take is normal";
}

TEST_F(OwedTest, WhatComesRightAfterAnAnswerMayHaveItAlready) {
  // A and B may both answer to another one, and come now in this order, now in that.
  learn(8 * kSecond);
  scorer_->add({0, kB});
  scorer_->add({500 * kMillisecond, kA});
  EXPECT_EQ(evidenceAt(10 * kSecond), 0);
  scorer_->add({11 * kSecond, kA});
  EXPECT_DOUBLE_EQ(evidenceAt(12 * kSecond), 1) << "the next one has none";
}

TEST_F(OwedTest, WhoeverAnswersSoonestIsAskedFirst) {
  // B answers to A at once, and to C only by chance: with room for one, it owes A.
  Tuning tuning;
  tuning.deadlines = 1;
  const auto start = [&](unsigned seed) {
    const Events asked = irregular(kC, 0, 1600 * kSecond, 8 * kSecond, seed);
    const Events middle = answers(kA, asked, 400 * kMillisecond);
    return startOf(together({asked, middle, answers(kB, middle, 100 * kMillisecond)}),
                   std::int64_t{10} * seed);
  };
  const Model model(watch(start(1), start(2), SourceGraph(), tuning));
  EXPECT_LT(indexOf(model.tracks(), kDeadlines, kB, kA), model.tracks().size());
  EXPECT_EQ(indexOf(model.tracks(), kDeadlines, kB, kC), model.tracks().size());
}

}  // namespace
}  // namespace self_awareness::core::evidence
