#include "core/evidence/channel/company.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "channel_case.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kFast = 50 * kMillisecond;
constexpr std::int64_t kSlow = 120 * kMillisecond;
constexpr std::int64_t kSession = 20 * kSecond;

/// A timer that runs in every second stretch of a length, from `first` on.
Events inSessions(EventId id, std::int64_t first, std::int64_t period, std::int64_t session) {
  std::vector<Events> sessions;
  Events events;
  for (int number = 0; number < 5; ++number) {
    const std::int64_t start = first + 2 * number * session;
    const Events one = timer(id, start, start + session, period);
    events.insert(events.end(), one.begin(), one.end());
  }
  return events;
}

/// A and B run in the same sessions, and C does all the time.
Events modes(std::int64_t begin) {
  return later(together({inSessions(kA, 10 * kMillisecond, kFast, kSession),
                         inSessions(kB, 0, kSlow, kSession),
                         timer(kC, 0, 10 * kSession, 500 * kMillisecond)}),
               begin);
}

class CompanyTest : public TrackTest {
 protected:
  void learn(const SourceGraph& graph = {}) {
    learn(countsOf({modes(kStart)}), countsOf({modes(2 * kStart)}), graph);
  }
  void learn(const Statistics& first, const Statistics& second, const SourceGraph& graph = {}) {
    TrackTest::learn(watch(first, second, graph), kCompany, kA, kB);
  }
  bool watches(EventId to, EventId from) const {
    return isWatched(model_->tracks(), kCompany, to, from);
  }
};

TEST_F(CompanyTest, WhoPausesTogetherIsInCompany) {
  learn();
  EXPECT_TRUE(watches(kA, kB));
  EXPECT_TRUE(watches(kB, kA));
  EXPECT_FALSE(watches(kA, kC)) << "it goes on while A pauses";
  EXPECT_FALSE(watches(kC, kA)) << "it does not pause";
}

TEST_F(CompanyTest, PausesOfOneStartMayBeChance) {
  learn(countsOf({modes(kStart)}), countsOf({modes(kStart + kSecond)}));
  EXPECT_FALSE(watches(kA, kB));
}

TEST_F(CompanyTest, OtherPausesAreNoCompany) {
  const auto start = [](std::int64_t begin, std::int64_t session) {
    return countsOf({later(together({inSessions(kA, 0, kFast, kSession),
                                     inSessions(kB, 5 * kSecond, kSlow, session)}),
                           begin)});
  };
  learn(start(kStart, kSession * 3 / 4), start(2 * kStart, kSession / 2));
  EXPECT_FALSE(watches(kA, kB));
  EXPECT_FALSE(watches(kB, kA));
}

TEST_F(CompanyTest, WhoseMessagesItIsSentByFallsSilentWithIt) {
  SourceGraph graph;
  graph.connect("/a", "/x", "/b");
  learn(graph);
  EXPECT_FALSE(watches(kA, kB)) << "B hears A, so it cannot tell that A has died";
  EXPECT_TRUE(watches(kB, kA));
}

TEST_F(CompanyTest, SilenceCountsWhileTheOtherGoesOn) {
  learn();
  scorer_->add({0, kA});
  for (int k = 1; k <= 10; ++k) {
    scorer_->add({k * kSlow, kB});
  }
  EXPECT_EQ(evidenceAt(2 * kSecond), 10);
  EXPECT_EQ(reason().kind, Kind::kSilent);
  EXPECT_EQ(reason().after, "/b /y T");
  EXPECT_EQ(reason().unit, unit::kRequests);
  EXPECT_EQ(reason().value, 10);
  EXPECT_EQ(reason().words, "has not come with the last 10 /b /y T, which pauses when it does");
  EXPECT_EQ(evidenceAt(100 * kSecond), 10) << "a pause of both is none of one";
  scorer_->add({100 * kSecond, kA});
  EXPECT_EQ(evidenceAt(101 * kSecond), 0);
}

TEST_F(CompanyTest, WhoWasNeverHeardMayBeStartingForAMinute) {
  learn();
  for (std::int64_t stamp = 0; stamp < 60 * kSecond; stamp += kSlow) {
    scorer_->add({stamp, kB});
  }
  EXPECT_EQ(evidenceAt(60 * kSecond - kWindow), 0);
  EXPECT_EQ(evidenceAt(60 * kSecond), 500);
}

TEST_F(CompanyTest, ARestartForgetsIt) {
  learn();
  scorer_->add({0, kA});
  scorer_->add({kSlow, kB});
  EXPECT_EQ(evidenceAt(kSecond), 1);
  scorer_->forget(kB);
  EXPECT_EQ(evidenceAt(kSecond), 0);
  scorer_->add({kSecond, kB});
  scorer_->restart();
  scorer_->add({20 * kSecond, kA});
  EXPECT_EQ(evidenceAt(30 * kSecond), 0);
}

TEST_F(CompanyTest, ItIsJudgedWhereItSaysMoreThanSilence) {
  learn();
  const Expectation& expected = model_->expectation(track_);
  EXPECT_EQ(expected.limit(track_, 3, 7), 7);
  EXPECT_TRUE(std::isnan(expected.limit(track_, 1000, 2000))) << "as long as a pause";
}

TEST_F(CompanyTest, ALeastTimePassesHoweverFastTheOtherIs) {
  learn();
  const auto least = [&](EventId to, EventId from) {
    const std::size_t track = indexOf(model_->tracks(), kCompany, to, from);
    return model_->leastLimit(track);
  };
  EXPECT_NEAR(least(kB, kA), model_->tuning().least_lateness / toSeconds(kFast), 2);
  EXPECT_NEAR(least(kA, kB), model_->tuning().least_lateness / toSeconds(kSlow), 1);
}

}  // namespace
}  // namespace self_awareness::core::evidence
