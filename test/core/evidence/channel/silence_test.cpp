#include "core/evidence/channel/silence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>

#include "channel_case.h"
#include "core/evidence/channel/channel.h"

namespace self_awareness::core::evidence {
namespace {

class SilenceTest : public FollowedTest {
 protected:
  std::size_t overdue_ = track(kOverdue, kA, kA);
};

TEST_F(SilenceTest, WhatNeverPausedHasNoLimit) {
  const Expectation& expectation = model_->expectation(overdue_);
  EXPECT_DOUBLE_EQ(expectation.limit(overdue_, 0, 1), 1);
  EXPECT_DOUBLE_EQ(expectation.limit(overdue_, 0, 1e30), toSeconds(kLongestAge));
  EXPECT_TRUE(std::isnan(expectation.limit(overdue_, 0, 0))) << "all came at one moment";
}

TEST_F(SilenceTest, ASuspectIsToldOfByWhatTrainingMeasured) {
  add({now_, kA});
  now_ += 5 * kSecond;
  const Suspect silent = suspect(overdue_);
  EXPECT_EQ(silent.reason.kind, Kind::kSilent);
  EXPECT_EQ(silent.reason.unit, unit::kSeconds);
  EXPECT_DOUBLE_EQ(silent.reason.value, 5);
  EXPECT_DOUBLE_EQ(silent.reason.lasted, 5);
  EXPECT_DOUBLE_EQ(silent.reason.usual * 1e9, model_->meanGap(kA));
  EXPECT_LT(silent.reason.usual_shortest, silent.reason.usual);
  EXPECT_GT(silent.reason.usual_longest, silent.reason.usual);
  char text[100];
  std::snprintf(text, sizeof text, "silent for 5.00 s, usually every %.3f s, at most %.3f s",
                silent.reason.usual, toSeconds(model_->longestGap(kA)));
  EXPECT_EQ(silent.reason.words, text);
}

TEST_F(SilenceTest, ASuspectIsNotSaidToBeUsuallyHeardSoonerThanTrainingShowed) {
  const std::vector<std::int64_t>& gaps = model_->statistics().type(kA).longest_gaps;
  add({now_, kA});
  now_ += (gaps.at(0) + gaps.at(1)) / 2;
  char text[100];
  std::snprintf(text, sizeof text, "longer once in training: %.3f s", toSeconds(gaps.at(0)));
  EXPECT_NE(suspect(overdue_).reason.words.find(text), std::string::npos);
  add({now_, kA});
  now_ += gaps.at(2);
  EXPECT_NE(suspect(overdue_).reason.words.find("longer now and then: up to"), std::string::npos);
}

TEST_F(SilenceTest, ThatOneWhoPausesComesAfterAllIsNewsOnce) {
  scorer_.capAt(allLimits(*model_, 2));
  const auto beSilent = [&](std::int64_t silence) {
    add({now_, kA});
    for (const std::int64_t end = now_ + silence; now_ < end;) {
      now_ += kWindow;
      scorer_.closeWindow(now_);
    }
    return evidence(overdue_);
  };
  EXPECT_DOUBLE_EQ(beSilent(5 * kSecond), 5);
  EXPECT_DOUBLE_EQ(beSilent(3 * kSecond), 3) << "the one before was too long to be a pause";
  EXPECT_EQ(scorer_.raisedBy(overdue_), 0);
  EXPECT_LT(beSilent(3500 * kMillisecond), 2) << "it may pause for 3 s, and a quarter more";
  EXPECT_NEAR(scorer_.raisedBy(overdue_), 1.25 * 3 - 2, 0.2);
  EXPECT_GT(beSilent(4 * kSecond), 2);
  restart();
  EXPECT_DOUBLE_EQ(beSilent(3 * kSecond), 3);
  scorer_.capAt(allLimits(*model_, 20));
  EXPECT_DOUBLE_EQ(beSilent(30 * kSecond), 30) << "it was gone";
  EXPECT_LT(beSilent(30 * kSecond), 20) << "and came back: it may pause for so long";
}

TEST_F(TrackTest, ThatATimerComesAfterAllIsNewsAgain) {
  const Events ticks = timer(kA, 0, 100 * kSecond, kPeriod);
  learn(watch(startOf(ticks, 1), startOf(ticks, 2)), kOverdue, kA, kA);
  scorer_->capAt(allLimits(*model_, 0.6));
  for (const std::int64_t stamp : {std::int64_t{0}, 950 * kMillisecond}) {
    scorer_->add({stamp, kA});
    EXPECT_DOUBLE_EQ(evidenceAt(stamp + 900 * kMillisecond), 0.9);
  }
}

TEST_F(TrackTest, AnotherValueOfWhoPausesEndsItsSilence) {
  const std::vector<EventType> types{{"/b", "/y", "T[status=3]"},
                                     {"/b", "/y", "T[status=4]"},
                                     {"/rosout", "/rosout", "L[level=4]"},
                                     {"/rosout", "/rosout", "L[level=2]"}};
  constexpr EventId kComplaint = 2;
  const auto start = [&](std::int64_t number) {
    return countsOf(
        {later(atRandom(types.size(), 0, 900 * kSecond, 8 * kSecond, 7), number * kStart)}, types);
  };
  learn(watch(start(1), start(2)), kOverdue, kA, kA);
  scorer_->add({0, kA});
  EXPECT_DOUBLE_EQ(evidenceAt(20 * kSecond), 20);
  scorer_->add({30 * kSecond, kB});
  EXPECT_DOUBLE_EQ(evidenceAt(32 * kSecond), 2);
  EXPECT_DOUBLE_EQ(reason().value, 2);
  EXPECT_EQ(indexOf(model_->tracks(), kOverdue, kComplaint, kComplaint), model_->tracks().size())
      << "that nobody complains is no fault";
  EXPECT_LT(indexOf(model_->tracks(), kOverdue, kComplaint + 1, kComplaint + 1),
            model_->tracks().size());
}

}  // namespace
}  // namespace self_awareness::core::evidence
