#include "core/evidence/explain/explanation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "../judged.h"
#include "../tracks.h"
#include "core/evidence/presence/strangers.h"

namespace self_awareness::core::evidence {
namespace {

// A comes at random, about every 200 ms, B 20 ms after it, and C often.
Events robot(std::int64_t length, unsigned seed) {
  return together(
      {followed(seed, length), irregular(kC, 0, length, 30 * kMillisecond, seed + 100)});
}

// A asks about every 4 s, B answers after 0.4 s, and C comes often.
Events requests(std::int64_t length, unsigned seed) {
  const Events asked = irregular(kA, 0, length, 4 * kSecond, seed);
  return together({asked, answers(kB, asked, 400 * kMillisecond),
                   irregular(kC, 0, length, 30 * kMillisecond, seed + 100)});
}

// Shares of their limits that tracks have reached.
using Reached = std::vector<std::pair<Track, double>>;

class ExplanationTest : public testing::Test {
 public:
  void add(const Event& event) {
    scorer_.add(event);
    events_.add(event, scorer_.stalled());
    last_ = event.stamp;
  }

 protected:
  ExplanationTest() { addAll(*this, robot(10 * kSecond, 3)); }
  /// Goes on with another model, once it has heard this.
  void restart(const Watched& watched, const Events& heard) {
    model_ = std::make_shared<Model>(watched);
    scorer_ = Scorer(model_, kWindow);
    events_ = RecentEvents(model_->size());
    addAll(*this, heard);
  }
  // Names the suspects when tracks have reached these shares of their limits.
  std::vector<Suspect> suspects(const Reached& reached, std::int64_t end,
                                const Window& window = {}) {
    std::vector<double> shares = allTracks(*model_, 0);
    for (const auto& [track, share] : reached) {
      ofTrack(shares, *model_, channelName(track), track.to, track.from) = share;
    }
    scorer_.closeWindow(end);
    const std::vector<Excess> excesses = excessesOf(model_, shares, scorer_);
    std::vector<Suspect> named =
        Explanation(model_).suspects(Moment(model_, graph_).in(excesses, scorer_, events_));
    Strangers(*model_, nullptr, graph_)
        .addUnknown(window, std::numeric_limits<std::int64_t>::min(), named);
    return named;
  }
  Ids named(const Reached& reached, std::int64_t end) { return idsOf(suspects(reached, end)); }
  static Track overdue(EventId id) { return trackOf(kOverdue, id, id); }

  std::shared_ptr<const Model> model_ = std::make_shared<Model>(
      watchAll(countsOf({robot(100 * kSecond, 1)}), countsOf({later(robot(100 * kSecond, 2))})));
  std::shared_ptr<SourceGraph> graph_ = std::make_shared<SourceGraph>();
  Scorer scorer_{model_, kWindow};
  RecentEvents events_{model_->size()};
  std::int64_t last_ = 0;
};

TEST_F(ExplanationTest, WithoutAGraphTheLeastProbableSilenceComesFirst) {
  const std::int64_t end = last_ + 5 * kSecond;
  ASSERT_LT(model_->logSurvival(kC, end - *scorer_.heard().lastSeen(kC)),
            model_->logSurvival(kA, end - *scorer_.heard().lastSeen(kA)));
  EXPECT_EQ(named({{overdue(kA), 1.5}, {overdue(kC), 1.2}}, end), (Ids{kC, kA}));
}

TEST_F(ExplanationTest, TheRootOfTheSilentComesBeforeItsVictims) {
  graph_->connect("/a", "/a/out", "/b");
  graph_->connect("/b", "/b/out", "/c");
  EXPECT_EQ(named({{overdue(kA), 1.1}, {overdue(kB), 1.5}, {overdue(kC), 3}}, last_ + 5 * kSecond),
            (Ids{kA, kB, kC}));
  const std::vector<Suspect> near =
      suspects({{overdue(kA), 0.8}, {overdue(kB), 1.5}}, last_ + 5 * kSecond);
  EXPECT_EQ(idsOf(near), (Ids{kA, kB})) << "near its limit, it is named already";
  EXPECT_FALSE(near[0].abnormal);
  EXPECT_TRUE(near[1].abnormal);
  EXPECT_EQ(near[0].roots, std::set<std::string>{});
  EXPECT_EQ(near[1].roots, std::set<std::string>{"/a"});
}

TEST_F(ExplanationTest, WhoIsSilentForLongerThanEverIsARootAndNoMore) {
  const std::int64_t end = last_ + 2 * model_->longestGap(kA);
  const Reached reached{{overdue(kA), 0.5}, {overdue(kC), 1.5}};
  EXPECT_EQ(named(reached, end), Ids{kC}) << "nobody hears it";
  graph_->connect("/a", "/a/out", "/c");
  EXPECT_EQ(named(reached, end), (Ids{kA, kC}));
  EXPECT_EQ(named(reached, last_ + kMillisecond), Ids{kC});
}

TEST_F(ExplanationTest, WhoFellSilentAfterItsVictimIsNoRoot) {
  graph_->connect("/a", "/a/out", "/b");
  const std::int64_t later = last_ + 10 * model_->longestGap(kB);
  add({later, kA});
  EXPECT_EQ(named({{overdue(kA), 1.5}, {overdue(kB), 1.5}}, later + 5 * kSecond), (Ids{kB, kA}));
}

TEST_F(ExplanationTest, OfWhoIsStillHeardATopicIsSilentOrAnAnswerMissing) {
  const std::vector<EventType> types{{"/a", "/x", "T"}, {"/b", "/y", "T"}, {"/b", "/z", "T"}};
  restart(watchAll(countsOf({requests(400 * kSecond, 1)}, types),
                   countsOf({later(requests(400 * kSecond, 2))}, types)),
          requests(20 * kSecond, 3));
  const auto kindOf = [&](const Track& track) {
    return suspects({{track, 1.5}}, last_ + 60 * kSecond).at(0).reason.kind;
  };
  add({last_ + kSecond, kA});
  EXPECT_EQ(toString(kindOf(overdue(kB))), "silent");
  EXPECT_EQ(toString(kindOf(trackOf(kDeadlines, kB, kA))), "silent") << "nothing of it comes";
  add({last_ + 30 * kSecond, kC});
  EXPECT_EQ(toString(kindOf(overdue(kB))), "topic silent");
  EXPECT_EQ(toString(kindOf(trackOf(kDeadlines, kB, kA))), "unanswered");
}

TEST_F(ExplanationTest, LongerGapsAreSaidAsAnotherRateNotAsASilence) {
  for (int i = 0; i < 6; ++i) {
    add({last_ + kSecond, kA});
  }
  const std::int64_t end = last_ + kSecond;
  const Track gaps = trackOf(kSlower, kA, kA);
  ASSERT_TRUE(isWatched(model_->tracks(), kSlower, kA, kA));
  const Suspect slow = suspects({{overdue(kA), 0.9}, {gaps, 1.2}}, end).at(0);
  EXPECT_EQ(slow.reason.kind, Kind::kSlow);
  EXPECT_EQ(slow.reason.words, "10 in the last 6.9 s, usually 30 to 40");
  EXPECT_EQ(suspects({{overdue(kA), 1.1}, {gaps, 1.2}}, end).at(0).reason.kind, Kind::kSilent);
}

TEST_F(ExplanationTest, WhoDoesWhatIsUsualIsNoSuspect) {
  // Near its limit, and its age is rare, but no longer than the longest gap of training.
  const std::int64_t end = *scorer_.heard().lastSeen(kA) + model_->longestGap(kA);
  ASSERT_LT(model_->logSurvival(kA, model_->longestGap(kA)), std::log(model_->tuning().rare));
  const Reached reached{{overdue(kA), 0.9}, {trackOf(kFaster, kC, kC), 1.5}};
  EXPECT_EQ(named(reached, end), Ids{kC});
  graph_->connect("/a", "/a/out", "/c");
  EXPECT_EQ(named(reached, end), Ids{kC}) << "upstream or not";
  EXPECT_EQ(named(reached, end + 1), (Ids{kA, kC}));
}

TEST_F(ExplanationTest, ALateAnswererIsNamedBeforeTheOneThatAsks) {
  const std::vector<Suspect> named = suspects({{trackOf(kPairs, kB, kA), 1.5}}, last_ + kWindow);
  ASSERT_EQ(idsOf(named), Ids{kB});
  EXPECT_EQ(named.front().reason.kind, Kind::kOutOfOrder) << "none of its delays was unusual";
  EXPECT_EQ(named.front().reason.after, toString(kTypes[kA]));
  EXPECT_NEAR(named.front().reason.value, 0.020, 1e-9);
  EXPECT_NEAR(named.front().reason.usual_shortest, 0.020, 0.004);
}

// A asks, B answers after 20 ms, and C answers B after 30 ms.
Events chain(std::int64_t start, std::int64_t length, std::int64_t delay, unsigned seed) {
  const Events asked = irregular(kA, start, start + length, 200 * kMillisecond, seed);
  const Events relayed = answers(kB, asked, delay);
  return together({asked, relayed, answers(kC, relayed, 30 * kMillisecond)});
}

class ExplanationOfAChainTest : public ExplanationTest {
 protected:
  ExplanationOfAChainTest() {
    const Statistics first = countsOf({chain(0, 100 * kSecond, 20 * kMillisecond, 1)});
    const Statistics second = countsOf({chain(kStart, 100 * kSecond, 20 * kMillisecond, 2)});
    Watched watched = watchAll(first, second);
    watched.tracks.push_back(delay(kC, kA));  // as models of method 16 do, beside C after B
    watched.halves = {first, second};
    restart(watched, chain(0, 20 * kSecond, 20 * kMillisecond, 3));
  }
  static Track delay(EventId to, EventId from) { return trackOf(kPairs, to, from); }
};

TEST_F(ExplanationOfAChainTest, TheOneWhoseDelayGrewComesBeforeWhoFollowsItAsUsual) {
  // B answers later than usual, and C it as usual.
  addAll(*this, chain(last_ + 100 * kMillisecond, 2 * kSecond, 80 * kMillisecond, 4));
  const std::int64_t end = last_ + kMillisecond;
  EXPECT_EQ(named({{delay(kB, kA), 1.1}, {delay(kC, kA), 1.9}}, end), (Ids{kB, kC}));
  EXPECT_EQ(named({{delay(kB, kA), 1.1}, {delay(kC, kA), 1.9}, {delay(kC, kB), 1.5}}, end),
            (Ids{kC, kB}))
      << "who does not follow as usual is to blame itself";
  EXPECT_EQ(named({{delay(kB, kA), 1.1}, {delay(kC, kB), 1.9}}, end), Ids{kB})
      << "who is late only after one that is late itself is not named";
}

TEST_F(ExplanationOfAChainTest, WithoutAGraphWhoIsFollowedIsToBlameForASilence) {
  // A goes on, at another rate, and C has answered.
  const std::int64_t end = *scorer_.heard().lastSeen(kC) + 2 * model_->longestGap(kC);
  EXPECT_EQ(named({{overdue(kC), 1.1}, {trackOf(kSlower, kB, kB), 1.5}}, end), (Ids{kB, kC}));
  EXPECT_EQ(named({{overdue(kC), 3}, {overdue(kB), 1.5}, {overdue(kA), 1.1}}, last_ + 5 * kSecond),
            (Ids{kA, kB, kC}));
}

// A is a timer, B answers to every second message after 60 ms, and C often comes at random.
Events everySecond(std::int64_t start, std::int64_t length, std::int64_t period, unsigned seed) {
  return together({timer(kA, start, start + length, period),
                   timer(kB, start + period + 60 * kMillisecond, start + length, 2 * period),
                   irregular(kC, start, start + length, 30 * kMillisecond, seed)});
}

TEST_F(ExplanationTest, WhoAnswersEverySecondMessageIsNotToBlameWhileTheseComeAtHalfTheRate) {
  constexpr std::int64_t kPeriod = 100 * kMillisecond;
  restart(watchAll(countsOf({everySecond(0, 100 * kSecond, kPeriod, 1)}),
                   countsOf({everySecond(kStart, 100 * kSecond, kPeriod, 2)})),
          everySecond(0, 20 * kSecond, kPeriod, 3));
  graph_->connect("/a", "/x", "/b");
  ASSERT_EQ(scorer_.heard().lastSeen(kB), 19960 * kMillisecond);
  ASSERT_EQ(scorer_.heard().lastSeen(kA), 19900 * kMillisecond);
  const Reached reached{{overdue(kB), 1.2}, {trackOf(kSlower, kA, kA), 1.2}};
  add({20100 * kMillisecond, kA});
  EXPECT_EQ(named(reached, 20290 * kMillisecond), (Ids{kA, kB}));
  graph_->connect("/c", "/z", "/a");
  EXPECT_EQ(named({reached[0], reached[1], {overdue(kC), 1.5}}, 20290 * kMillisecond),
            (Ids{kC, kB, kA}))
      << "why they come at half the rate is gone";
  add({20300 * kMillisecond, kA});
  EXPECT_EQ(named(reached, 20340 * kMillisecond), (Ids{kA, kB})) << "it has time to answer";
  EXPECT_EQ(named(reached, 20400 * kMillisecond), (Ids{kB, kA}));
}

TEST_F(ExplanationTest, WhoOwesAnAnswerIsNamedAsASilentOne) {
  restart(watchAll(startOf(requests(400 * kSecond, 1), 0), startOf(requests(400 * kSecond, 2), 1)),
          requests(20 * kSecond, 3));
  add({last_ + kSecond, kA});
  const std::vector<Suspect> named = suspects(
      {{trackOf(kFaster, kC, kC), 1.9}, {trackOf(kDeadlines, kB, kA), 1.1}}, last_ + 2 * kSecond);
  EXPECT_EQ(idsOf(named), (Ids{kB, kC}));
  EXPECT_EQ(named.front().reason.kind, Kind::kSilent);
  EXPECT_EQ(named.front().reason.words, "has not come for 2.00 s after /a /x T");
}

TEST_F(ExplanationTest, WhoIsLateAfterOneThatIsUnusualOrWithinItsLimitIsNotNamed) {
  // B's delays after A are unusual because A comes at another rate.
  EXPECT_EQ(
      named({{trackOf(kPairs, kB, kA), 1.9}, {trackOf(kFaster, kA, kA), 1.1}}, last_ + kWindow),
      Ids{kA});
  EXPECT_EQ(
      named({{trackOf(kFaster, kA, kA), 0.5}, {trackOf(kFaster, kC, kC), 1.1}}, last_ + kWindow),
      Ids{kC});
}

TEST_F(ExplanationTest, TheOrderOfItsOwnEventsIsAnOwnFault) {
  // A and B are of one component, and C's delays after B are unusual because of that.
  const std::vector<EventType> types{{"/a", "/x", "T"}, {"/a", "/y", "T"}, {"/c", "/z", "T"}};
  restart(watchAll(countsOf({chain(0, 100 * kSecond, 20 * kMillisecond, 1)}, types),
                   countsOf({chain(kStart, 100 * kSecond, 20 * kMillisecond, 2)}, types)),
          chain(0, 20 * kSecond, 20 * kMillisecond, 3));
  EXPECT_EQ(
      named({{trackOf(kPairs, kB, kA), 1.1}, {trackOf(kPairs, kC, kB), 1.9}}, last_ + kWindow),
      Ids{kB});
}

TEST_F(ExplanationTest, UnknownEventsAreNamedLastAndNoMoreThanFive) {
  Window window;
  for (const EventId id : {5U, 4U, 5U}) {
    window.events.push_back({{last_, id}, true, std::nullopt});
  }
  window.events.push_back({{last_, kA}, false, std::nullopt});
  const std::vector<Suspect> named = suspects({{overdue(kA), 1.5}}, last_ + 5 * kSecond, window);
  ASSERT_EQ(idsOf(named), (Ids{kA, 5, 4}));
  EXPECT_EQ(named[1].reason.kind, Kind::kStranger);
  EXPECT_EQ(named[1].reason.value, 2);
  EXPECT_EQ(named[2].reason.value, 1);
  for (EventId id = 10; id < 20; ++id) {
    window.events.push_back({{last_, id}, true, std::nullopt});
  }
  EXPECT_EQ(suspects({}, last_ + kWindow, window).size(), kMostSuspects);
}

TEST_F(ExplanationTest, FurtherComponentsFollowIfTheirEvidenceAloneIsAbnormal) {
  std::vector<EventType> types;
  Events events;
  for (const std::string name : {"/a", "/b", "/c", "/d", "/e", "/e", "/f", "/g"}) {
    const auto id = static_cast<EventId>(types.size());
    types.push_back({name, "/topic" + std::to_string(id), "T"});
    events = together({events, timer(id, 0, 100 * kSecond, (90 + 10 * id) * kMillisecond)});
  }
  restart(watchAll(countsOf({events}, types), {}), events);
  Reached reached;
  for (EventId id = 0; id < types.size(); ++id) {
    reached.emplace_back(overdue(id), id == 6 ? 0.5 : 1.5);
  }
  // 5 is another type of a component that is named, 6 is far from its limit.
  Ids further = named(reached, last_ + 3 * kSecond);
  std::sort(further.begin(), further.end());
  EXPECT_EQ(further, (Ids{0, 1, 2, 3, 4, 7}));
}

TEST_F(ExplanationTest, ATopicIsNamedIfItsSenderIsNotKnown) {
  std::vector<EventType> types = kTypes;
  for (EventType& type : types) {
    type.source.clear();
  }
  model_ = std::make_shared<Model>(watchAll(countsOf({robot(100 * kSecond, 1)}, types), {}));
  graph_->connect("/x", "/x/out", "/z");
  EXPECT_EQ(named({{overdue(kA), 1.5}, {overdue(kC), 1.5}}, last_ + 5 * kSecond), (Ids{kA, kC}));
}

}  // namespace
}  // namespace self_awareness::core::evidence
