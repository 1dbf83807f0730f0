#include "core/evidence/channel/scorer.h"

#include <gtest/gtest.h>

#include <optional>

#include "channel_case.h"

namespace self_awareness::core::evidence {
namespace {

class EvidenceScorerTest : public FollowedTest {};

TEST_F(EvidenceScorerTest, WhatWasGoneMustBeArmedAgain) {
  for (const EventId gone : {kA, kB}) {
    const std::size_t pair = track(kPairs, kB, kA);
    restart();
    askUsually(kArming);
    ask(kUnusual);
    EXPECT_GT(evidence(pair), 0);
    const std::int64_t end = now_ + 6 * model_->longestGap(gone);
    for (; now_ < end; now_ += kPeriod) {
      add({now_, gone == kA ? kB : kA});
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
  const std::size_t pair = track(kPairs, kB, kA);
  askUsually(kArming);
  now_ += 4 * model_->longestGap(kA);
  askUsually(1);
  ask(kUnusual);
  EXPECT_GT(evidence(pair), 0);
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
  restart();
  for (const double evidence : scorer_.closeWindow(now_ + 100 * kSecond)) {
    EXPECT_EQ(evidence, 0);
  }
  EXPECT_EQ(scorer_.heard().lastSeen(kA), std::nullopt);
}

}  // namespace
}  // namespace self_awareness::core::evidence
