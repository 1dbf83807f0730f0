#include "self_awareness/core/evidence/watch/tracks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "../recordings.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kLength = 60 * kSecond;
const double kFewestDelays = Tuning{}.fewest_delays;

std::vector<Track> chosen(const Statistics& first, const Statistics& second) {
  return watch(first, second).tracks;
}

// Two timers of the same period, the second one later than the first by a phase, and a third type
// at random times.
Statistics twoTimers(std::int64_t phase) {
  return countsOf({together({timer(kA, 0, kLength, 100 * kMillisecond),
                             timer(kB, phase, kLength, 100 * kMillisecond),
                             irregular(kC, 0, kLength, 50 * kMillisecond, 1)})});
}

// A comes at random, and B follows it.
Statistics followed(unsigned seed) {
  const Events asked = irregular(kA, 0, kLength, 200 * kMillisecond, seed);
  return countsOf({later(together({asked, answers(kB, asked, 20 * kMillisecond)}), seed * kStart)},
                  2);
}

Statistics gapsOf(EventId id, std::int64_t gaps) {
  return countsOf({timer(id, 0, gaps * kSecond + 1, kSecond)});
}

TEST(EvidenceTracks, APairWithAStableDelayIsChosen) {
  const std::vector<Track> tracks = chosen(followed(1), followed(2));
  EXPECT_TRUE(isWatched(tracks, Channel::kDelay, kB, kA));
  EXPECT_TRUE(isWatched(tracks, Channel::kSlowDelay, kB, kA));
}

TEST(EvidenceTracks, APhaseThatOneHalfDoesNotConfirmIsNot) {
  const std::vector<Track> held =
      chosen(twoTimers(20 * kMillisecond), twoTimers(20 * kMillisecond));
  EXPECT_TRUE(isWatched(held, Channel::kDelay, kB, kA));
  const std::vector<Track> lost =
      chosen(twoTimers(20 * kMillisecond), twoTimers(70 * kMillisecond));
  EXPECT_FALSE(isWatched(lost, Channel::kDelay, kB, kA));
  EXPECT_FALSE(isWatched(lost, Channel::kDelay, kA, kB));
  EXPECT_TRUE(isWatched(lost, Channel::kDelay, kB, kB));  // its period is the same in both halves
}

TEST(EvidenceTracks, FewGapsAreNotJudged) {
  const auto needed = static_cast<std::int64_t>(Tuning{}.fewest_gaps);
  const std::vector<Track> few = chosen(gapsOf(kA, needed - 1), countsOf({}));
  EXPECT_TRUE(few.empty());
  const std::vector<Track> enough = chosen(gapsOf(kA, needed - 10), gapsOf(kA, 10));
  for (const Channel channel : {Channel::kOverdue, Channel::kFewer, Channel::kMore}) {
    EXPECT_TRUE(isWatched(enough, channel, kA, kA));
  }
  EXPECT_EQ(enough.size(), 3U);
}

TEST(EvidenceTracks, FewDelaysAreNoPair) {
  const auto asked = [](std::size_t number) {
    Events events = irregular(kA, 0, 1000 * kSecond, kSecond, 1);
    events.resize(number);
    return countsOf({together({events, answers(kB, events, 20 * kMillisecond)})}, 2);
  };
  EXPECT_TRUE(isWatched(chosen(asked(100), asked(100)), Channel::kDelay, kB, kA));
  EXPECT_FALSE(isWatched(chosen(asked(100), asked(99)), Channel::kDelay, kB, kA));
  EXPECT_TRUE(isWatched(chosen(asked(51), asked(51)), Channel::kAnswer, kB, kA));  // 100 gaps
  EXPECT_FALSE(isWatched(chosen(asked(51), asked(50)), Channel::kAnswer, kB, kA));
}

TEST(EvidenceTracks, TheThreeBestPredecessorsAreWatched) {
  constexpr EventId kNumber = 6;
  const Events asked = irregular(0, 0, kLength, 200 * kMillisecond, 1);
  Statistics counts;
  Events events;
  for (EventId id = 0; id < kNumber; ++id) {  // one after the other
    counts.intern({"/" + std::to_string(id), "/topic", "T"});
    events = together({events, answers(id, asked, 3 * kMillisecond * id)});
  }
  Trainer trainer(counts, kWindow);
  for (const std::int64_t start : {std::int64_t{0}, kStart}) {
    trainer.startRecording();
    for (const Event& event : later(events, start)) {
      trainer.add(event);
    }
  }
  trainer.finish();
  const InformationGain gain(counts, counts, kFewestDelays);
  const std::vector<Track> tracks = chosen(counts, counts);
  for (EventId to = 1; to < kNumber; ++to) {
    std::vector<double> watched;
    std::vector<double> others;
    for (EventId from = 0; from < kNumber; ++from) {
      const bool is_watched = isWatched(tracks, Channel::kDelay, to, from);
      (is_watched ? watched : others).push_back(gain(from, to));
    }
    ASSERT_EQ(watched.size(), 3U) << to;
    EXPECT_GE(*std::min_element(watched.begin(), watched.end()),
              *std::max_element(others.begin(), others.end()))
        << to;
  }
}

TEST(EvidenceTracks, AFollowerDoesNotAskForWhatItFollows) {
  const std::vector<Track> tracks = chosen(followed(1), followed(2));
  EXPECT_TRUE(isWatched(tracks, Channel::kAnswer, kB, kA));
  EXPECT_FALSE(isWatched(tracks, Channel::kAnswer, kA, kB));
  EXPECT_FALSE(isWatched(tracks, Channel::kAnswer, kA, kA));
}

TEST(EvidenceTracks, ATypeThatMostlyGetsNoAnswerDoesNotAsk) {
  const Events asked = irregular(kA, 0, kLength, 50 * kMillisecond, 2);
  for (const std::size_t every : {1U, 4U}) {
    Events answered;
    for (std::size_t k = 0; k < asked.size(); k += every) {
      answered.push_back({asked[k].stamp + 3 * kMillisecond, kB});
    }
    const Statistics counts = countsOf({together({asked, answered})}, 2);
    EXPECT_EQ(missRate(counts.type(kA).gaps, counts.answers(kA, kB)) > 0.6, every == 4);
    EXPECT_EQ(isWatched(chosen(counts, counts), Channel::kAnswer, kB, kA), every == 1);
  }
}

TEST(EvidenceTracks, WhatComesByChanceIsNoAnswer) {
  const Statistics counts =
      countsOf({together({irregular(kA, 0, kLength, 50 * kMillisecond, 2),
                          irregular(kB, 0, kLength, 200 * kMillisecond, 1)})},
               2);
  const std::vector<Track> tracks = chosen(counts, counts);
  ASSERT_LT(missRate(counts.type(kB).gaps, counts.answers(kB, kA)), 0.2);
  EXPECT_FALSE(isWatched(tracks, Channel::kAnswer, kA, kB)) << "A comes often, whatever B does";
}

TEST(EvidenceTracks, AsManyPredecessorsAreWatchedAsAreAskedFor) {
  const Statistics counts = followed(1);
  for (const std::size_t predecessors : {0U, 1U}) {
    Tuning tuning;
    set(tuning, "predecessors", static_cast<double>(predecessors));
    const Watched watched = watch(counts, counts, {}, tuning);
    EXPECT_TRUE(watched.tuning == tuning);
    const auto of_b = std::count_if(
        watched.tracks.begin(), watched.tracks.end(),
        [](const Track& track) { return track.channel == Channel::kDelay && track.to == kB; });
    EXPECT_EQ(static_cast<std::size_t>(of_b), predecessors);
  }
}

TEST(EvidenceTracks, CountsOfWatchedPairsAreKeptAndOthersLeftOut) {
  const Statistics first = twoTimers(20 * kMillisecond);
  const Statistics second = twoTimers(70 * kMillisecond);
  const Watched watched = watch(first, second);
  ASSERT_FALSE(isWatched(watched.tracks, Channel::kDelay, kA, kB));
  for (std::size_t half = 0; half < 2; ++half) {
    const Statistics& all = half == 0 ? first : second;
    const Statistics& kept = watched.halves.at(half);
    for (const Track& track : watched.tracks) {
      EXPECT_EQ(kept.delays(track.from, track.to), all.delays(track.from, track.to));
      EXPECT_EQ(kept.answers(track.from, track.to), all.answers(track.from, track.to));
    }
    EXPECT_EQ(kept.delaysToAny(), all.delaysToAny());
    EXPECT_EQ(kept.duration(), all.duration());
    EXPECT_EQ(kept.type(kA).longest_gaps, all.type(kA).longest_gaps);
  }
  // Leaving pairs out changes nothing else.
  EXPECT_TRUE(watched.halves[0].only({}).withoutPairs() == first.withoutPairs());
  EXPECT_EQ(first.only({}).partners(kA).size(), 0U);
  EXPECT_EQ(first.only({}).delaysToAny(), first.delaysToAny());
}

TEST(EvidenceTracks, DelayTracksComeInPairs) {
  const Track overdue{Channel::kOverdue, kA, kA};
  const Track now{Channel::kDelay, kB, kA};
  const Track slow{Channel::kSlowDelay, kB, kA};
  EXPECT_NO_THROW(checkTracks({overdue, now, slow}, 2));
  EXPECT_THROW(checkTracks({overdue}, 0), std::invalid_argument);
  EXPECT_THROW(checkTracks({now, slow}, 1), std::invalid_argument);
  EXPECT_THROW(checkTracks({now}, 2), std::invalid_argument);
  EXPECT_THROW(checkTracks({slow}, 2), std::invalid_argument);
  EXPECT_THROW(checkTracks({slow, now}, 2), std::invalid_argument);
  EXPECT_THROW(checkTracks({now, overdue, slow}, 2), std::invalid_argument);
  EXPECT_THROW(checkTracks({now, {Channel::kSlowDelay, kA, kB}}, 2), std::invalid_argument);
}

TEST(InformationGain, IsTheMeanLogRatioOnTheOtherHalf) {
  Statistics learned = countsOf({}, 2);
  learned.allPartners(kB)[kA].delays[10] = 50;
  learned.allPartners(kA)[kA].delays[20] = 100;
  Statistics measured = countsOf({}, 2);
  Statistics::Delays& delays = measured.allPartners(kB)[kA].delays;
  delays[10] = 30;
  delays[20] = 20;
  const InformationGain gain(learned, measured, kFewestDelays);
  // P: 51 and 1 of 100; Q: 51 and 101 of 200.
  EXPECT_NEAR(gain(kA, kB), (30 * std::log(2.0) + 20 * std::log(2.0 / 101)) / 50, 1e-12);
  EXPECT_EQ(gain(kA, kA), 0);  // not measured
  EXPECT_EQ(gain(kB, kA), 0);  // not learned
  delays[20] = 19;
  EXPECT_EQ(gain(kA, kB), 0);  // too little to measure on
}

TEST(InformationGain, IsZeroForATypeThatTheOtherHalfLacks) {
  const Statistics learned = followed(1);
  const Statistics measured = countsOf({irregular(kA, 0, kLength, 200 * kMillisecond, 2)}, 1);
  EXPECT_GT(InformationGain(learned, learned, kFewestDelays)(kA, kB), 0.3);
  EXPECT_EQ(InformationGain(learned, measured, kFewestDelays)(kA, kB), 0);
}

TEST(LogProbabilities, HaveOneMoreCountInEveryBin) {
  Statistics::Delays counts{};
  counts[1] = 10;
  counts[2] = 40;
  const LogProbabilities logs = logProbabilities(counts);
  EXPECT_DOUBLE_EQ(logs[0], std::log(0.01));
  EXPECT_DOUBLE_EQ(logs[1], std::log(0.11));
  EXPECT_DOUBLE_EQ(logs[2], std::log(0.41));
}

}  // namespace
}  // namespace self_awareness::core::evidence
