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
  const std::vector<Track> held =
      chosen(twoTimers(20 * kMillisecond), twoTimers(20 * kMillisecond));
  EXPECT_TRUE(isWatched(held, kPairs, kB, kA));
  const std::vector<Track> lost =
      chosen(twoTimers(20 * kMillisecond), twoTimers(70 * kMillisecond));
  EXPECT_FALSE(isWatched(lost, kPairs, kB, kA));
  EXPECT_FALSE(isWatched(lost, kPairs, kA, kB));
  EXPECT_TRUE(isWatched(lost, kSlower, kB, kB));  // its period is the same in both halves
}

TEST(EvidenceTracks, FewGapsAreNotJudged) {
  const auto needed = static_cast<std::int64_t>(Tuning{}.fewest_gaps);
  const std::vector<Track> few = chosen(gapsOf(kA, needed - 1), countsOf({}));
  EXPECT_TRUE(few.empty());
  const std::vector<Track> enough = chosen(gapsOf(kA, needed - 10), gapsOf(kA, 10));
  EXPECT_TRUE(isWatched(enough, kOverdue, kA, kA));
  EXPECT_EQ(enough.size(), 3U) << "its silence, and both other paces, which need more";
}

TEST(EvidenceTracks, FewDelaysAreNoPair) {
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
    std::vector<double> watched;
    std::vector<double> others;
    for (EventId from = 0; from < kNumber; ++from) {
      if (from != to) {
        const bool is_watched = isWatched(tracks, kPairs, to, from);
        (is_watched ? watched : others).push_back(gain(from, to));
      }
    }
    ASSERT_EQ(watched.size(), 1U) << to;
    EXPECT_GE(*std::min_element(watched.begin(), watched.end()),
              *std::max_element(others.begin(), others.end()))
        << to;
  }
}

TEST(EvidenceTracks, CountsOfWatchedPairsAreKeptAndOthersLeftOut) {
  const Statistics first = twoTimers(20 * kMillisecond);
  const Statistics second = twoTimers(70 * kMillisecond);
  const Watched watched = watch(first, second);
  ASSERT_FALSE(isWatched(watched.tracks, kPairs, kA, kB));
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

// Requests of A at random, about every 4 s; B answers so many of so many.
Statistics requests(std::size_t answers, std::size_t of) {
  const Events asked = irregular(kA, 0, 800 * kSecond, 4 * kSecond, 1);
  Events answered;
  for (std::size_t k = 0; k < asked.size(); ++k) {
    if (k % of < answers) {
      answered.push_back({asked[k].stamp + 400 * kMillisecond, kB});
    }
  }
  return countsOf({together({asked, answered})}, 2);
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
  EXPECT_EQ(channelNames(),
            (std::vector<std::string>{kOverdue, kSlower, kFaster, kPairs, kDeadlines, "company",
                                      "age", "lost", "size", "frozen", "values"}));
  const std::vector<std::string> labels{"overdue",   "pace",    "pace",  "pairs",
                                        "deadlines", "company", "age",   "lost",
                                        "size",      "frozen",  "values"};
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const Track track = trackOf(channelNames()[k], kA, kA);
    EXPECT_EQ(channelName(track), channelNames()[k]);
    EXPECT_EQ(channelLabel(track), labels[k]);
  }
  EXPECT_EQ(channelNamed("smell"), nullptr);
}

}  // namespace
}  // namespace self_awareness::core::evidence
