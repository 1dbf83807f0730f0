#include "self_awareness/core/evidence/channel/watched.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "../recordings.h"
#include "core/evidence/watch/gain.h"
#include "core/evidence/watch/relations.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kLength = 60 * kSecond;
const double kFewestDelays = Tuning{}.fewest_gaps;

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

Statistics gapsOf(EventId id, std::int64_t gaps) {
  return countsOf({timer(id, 0, gaps * kSecond + 1, kSecond)});
}

TEST(EvidenceTracks, APhaseThatOneHalfDoesNotConfirmIsNot) {
  const Statistics one = twoTimers(20 * kMillisecond);
  EXPECT_TRUE(isWatched(chosen(one, one), kPairs, kB, kA));
  const std::vector<Track> lost = chosen(one, twoTimers(70 * kMillisecond));
  EXPECT_FALSE(isWatched(lost, kPairs, kB, kA));
  EXPECT_FALSE(isWatched(lost, kPairs, kA, kB));
  EXPECT_TRUE(isWatched(lost, kSlower, kB, kB));  // its period is the same in both halves
}

TEST(EvidenceTracks, FewGapsAreNotJudgedAndFewDelaysAreNoPair) {
  const auto needed = static_cast<std::int64_t>(Tuning{}.fewest_gaps);
  EXPECT_TRUE(chosen(gapsOf(kA, needed - 1), countsOf({})).empty());
  const std::vector<Track> enough = chosen(gapsOf(kA, needed - 10), gapsOf(kA, 10));
  EXPECT_TRUE(isWatched(enough, kOverdue, kA, kA));
  EXPECT_EQ(enough.size(), 3U) << "its silence, and both other paces, which need more";
  const auto asked = [](std::size_t number) {
    Events events = irregular(kA, 0, 1000 * kSecond, kSecond, 1);
    events.resize(number);
    return countsOf({together({events, answers(kB, events, 20 * kMillisecond)})}, 2);
  };
  EXPECT_TRUE(isWatched(chosen(asked(100), asked(100)), kPairs, kB, kA));
  EXPECT_FALSE(isWatched(chosen(asked(100), asked(99)), kPairs, kB, kA));
}

TEST(EvidenceTracks, TheBestPredecessorsAreWatched) {
  constexpr EventId kNumber = 6;
  const Events asked = irregular(0, 0, kLength, 200 * kMillisecond, 1);
  Events events;
  for (EventId id = 0; id < kNumber; ++id) {  // one after the other
    events = together({events, answers(id, asked, 3 * kMillisecond * id)});
  }
  const Statistics counts = countsOf({events, later(events)}, numberedTypes(kNumber));
  const InformationGain gain(counts, counts, kFewestDelays);
  const std::vector<Track> tracks = chosen(counts, counts);
  for (EventId to = 1; to < kNumber; ++to) {
    std::vector<double> gains;
    for (EventId from = 0; from < kNumber; ++from) {
      gains.push_back(from == to ? 0 : gain(from, to));
    }
    const double best = *std::max_element(gains.begin(), gains.end());
    for (EventId from = 0; from < kNumber; ++from) {
      EXPECT_EQ(isWatched(tracks, kPairs, to, from), gains[from] == best) << from << " " << to;
    }
  }
}

TEST(EvidenceTracks, CountsOfWatchedPairsAreKeptAndOthersLeftOut) {
  const Halves all{twoTimers(20 * kMillisecond), twoTimers(70 * kMillisecond)};
  const Watched watched = watch(all[0], all[1]);
  ASSERT_FALSE(isWatched(watched.tracks, kPairs, kA, kB));
  for (std::size_t half = 0; half < 2; ++half) {
    const Statistics& kept = watched.halves.at(half);
    for (const Track& track : watched.tracks) {
      EXPECT_EQ(kept.delays(track.from, track.to), all[half].delays(track.from, track.to));
      EXPECT_EQ(kept.answers(track.from, track.to), all[half].answers(track.from, track.to));
    }
    EXPECT_EQ(kept.delaysToAny(), all[half].delaysToAny());
    EXPECT_EQ(kept.only({}).partners(kA).size(), 0U);
    EXPECT_TRUE(kept.only({}).withoutPairs() == all[half].withoutPairs()) << "nothing else";
  }
}

// Requests of A at random, about every 4 s; B answers so many of so many.
Statistics requests(std::size_t with_answer, std::size_t of) {
  const Events asked = irregular(kA, 0, 800 * kSecond, 4 * kSecond, 1);
  std::size_t number = 0;
  const Events some = without(asked, [&](const Event&) { return number++ % of >= with_answer; });
  return countsOf({together({asked, answers(kB, some, 400 * kMillisecond)})}, 2);
}

TEST(EvidenceTracks, AnAnswerThatIsAskedForIsOwedUnlessItIsLeftOutTooOften) {
  const auto isOwed = [](std::size_t answers, std::size_t of, EventId to, EventId from) {
    const Statistics counts = requests(answers, of);
    return isWatched(chosen(counts, counts), kDeadlines, to, from);
  };
  EXPECT_TRUE(isOwed(1, 1, kB, kA));
  EXPECT_FALSE(isOwed(1, 1, kA, kB)) << "a follower does not ask";
  EXPECT_FALSE(isOwed(1, 1, kA, kA));
  EXPECT_TRUE(isOwed(19, 20, kB, kA));
  EXPECT_TRUE(isOwed(4, 5, kB, kA));
  EXPECT_FALSE(isOwed(1, 3, kB, kA));
}

TEST(EvidenceTracks, ThoseFromOutsideAreChecked) {
  const Track overdue = trackOf(kOverdue, kA, kA);
  const Track pair = trackOf(kPairs, kB, kA);
  EXPECT_NO_THROW(checkTracks({overdue, pair}, 2));
  EXPECT_THROW(checkTracks({overdue, pair, overdue}, 2), std::invalid_argument);
  EXPECT_THROW(checkTracks({overdue}, 0), std::invalid_argument);
  EXPECT_THROW(checkTracks({pair}, 1), std::invalid_argument);
  EXPECT_THROW(checkTracks({trackOf(kPairs, kA, kB)}, 1), std::invalid_argument);
  EXPECT_THROW(checkTracks({trackOf("smell", kA, kA)}, 2), std::invalid_argument);
}

TEST(EvidenceTracks, EveryChannelHasANameOfItsOwnAndALabel) {
  const std::vector<std::string> labels{"overdue",   "pace",    "pace",  "pairs",
                                        "deadlines", "company", "age",   "lost",
                                        "size",      "frozen",  "values"};
  std::vector<std::string> names = labels;
  names[1] = kSlower;
  names[2] = kFaster;
  EXPECT_EQ(channelNames(), names);
  for (std::size_t k = 0; k < labels.size(); ++k) {
    EXPECT_EQ(channelName(trackOf(names[k], kA, kA)), names[k]);
    EXPECT_EQ(channelLabel(trackOf(names[k], kA, kA)), labels[k]);
  }
  EXPECT_EQ(channelNamed("smell"), nullptr);
}

}  // namespace
}  // namespace self_awareness::core::evidence
