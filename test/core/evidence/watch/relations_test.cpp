#include "core/evidence/watch/relations.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "../recordings.h"
#include "core/evidence/count/log_bins.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kLength = 60 * kSecond;
constexpr std::int64_t kPeriod = 100 * kMillisecond;
const SourceGraph kNoGraph;
const Tuning kTuning;
constexpr std::int64_t kSameStart = 60 * kSecond;

// Two exact timers of one period, and another type at random; the second timer is later by a
// phase, one in every start.
Statistics timers(const std::vector<std::int64_t>& phases) {
  std::vector<Events> recordings;
  for (const std::int64_t phase : phases) {
    recordings.push_back(
        later(together({timer(kA, 0, kLength, kPeriod), timer(kB, phase, kLength, kPeriod),
                        irregular(kC, 0, kLength, kPeriod, 1)}),
              static_cast<std::int64_t>(recordings.size()) * kStart));
  }
  return countsOf(recordings);
}

// A comes at random, and B so much after it, in so many starts.
Statistics followed(unsigned starts,
                    const std::vector<EventType>& types = {kTypes[kA], kTypes[kB]}) {
  std::vector<Events> recordings;
  for (unsigned start = 0; start < starts; ++start) {
    const Events asked = irregular(kA, 0, kLength, 2 * kPeriod, start + 1);
    recordings.push_back(
        later(together({asked, answers(kB, asked, 20 * kMillisecond)}), start * kStart));
  }
  return countsOf(recordings, types);
}

SourceGraph connected(const std::string& topic, int listeners = 1) {
  SourceGraph graph;
  graph.connect("/a", topic, "/b");
  for (int k = 1; k < listeners; ++k) {
    graph.connect("/a", topic, "/listener" + std::to_string(k));
  }
  return graph;
}

Relation delays(const Statistics& counts, const SourceGraph& graph = kNoGraph, EventId from = kA,
                EventId to = kB) {
  return Relations(counts, graph, kTuning).delays(from, to);
}

bool isOwed(const Statistics& counts, const SourceGraph& graph = kNoGraph) {
  return Relations(counts, graph, kTuning).owed(kA, kB).watched;
}

TEST(NumberOfStarts, RecordingsWithinAMinuteAreOneStart) {
  const auto seconds = [](std::vector<Span> spans) {
    for (Span& span : spans) {
      span.start *= kSecond;
      span.end *= kSecond;
    }
    return numberOfStarts(spans, kSameStart);
  };
  EXPECT_EQ(seconds({}), 0U);
  EXPECT_EQ(seconds({{0, 100}}), 1U);
  EXPECT_EQ(seconds({{0, 100}, {159, 200}}), 1U);
  EXPECT_EQ(seconds({{0, 100}, {160, 200}}), 2U);
  EXPECT_EQ(seconds({{160, 200}, {0, 100}}), 2U) << "in any order";
  EXPECT_EQ(seconds({{0, 1000}, {10, 20}, {1030, 1100}}), 1U) << "the longer one goes on";
  EXPECT_EQ(seconds({{0, 10}, {50, 60}, {100, 110}, {500, 510}}), 2U);
}

TEST(NumberOfStarts, WhenTheRobotWasStartedTellsStartsApart) {
  const auto seconds = [](std::int64_t start, std::int64_t end, std::int64_t robot_start) {
    return Span{start * kSecond, end * kSecond, robot_start * kSecond};
  };
  EXPECT_EQ(numberOfStarts({seconds(10, 20, 5), seconds(25, 30, 22)}, kSameStart), 2U)
      << "soon after";
  EXPECT_EQ(numberOfStarts({seconds(10, 20, 5), seconds(900, 950, 5)}, kSameStart), 1U)
      << "long after";
  EXPECT_EQ(startsOf({seconds(900, 950, 5), seconds(25, 30, 22), seconds(10, 20, 5)}, kSameStart),
            (std::vector<std::size_t>{0, 1, 0}));
  EXPECT_EQ(
      numberOfStarts({seconds(10, 20, 5), seconds(10, 20, 0), seconds(30, 40, 0)}, kSameStart), 2U)
      << "of the others it is not known";
}

TEST(Samples, AreRobotsWhereTheyAreSeveralElseStarts) {
  EXPECT_EQ(samplesOf({{0, 10, 1, "r1"}, {0, 10, 2, "r1"}, {0, 10, 2, "r2"}}, kSameStart),
            (std::vector<std::size_t>{0, 0, 1}));
  EXPECT_EQ(samplesOf({{0, 10, 1, "r1"}, {0, 10, 2, "r1"}}, kSameStart),
            (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(samplesOf({{0, 10, 1, ""}, {0, 10, 2, "r1"}}, kSameStart),
            (std::vector<std::size_t>{0, 1}))
      << "who has no name is another one";
  const std::vector<Span> spans{
      {0, 10, 5, "r1"}, {0, 10, 5, "r2"}, {2, 10, 0, "r1"}, {2, 10, 0, "r2"}, {3, 10, 0, "r2"}};
  EXPECT_EQ(startsOf(spans, kSameStart), (std::vector<std::size_t>{0, 1, 2, 3, 3}))
      << "a start is of one robot";
}

TEST(Relations, AsManyStartsAreEnoughAsItSaysAreNeeded) {
  const auto after = [](std::size_t starts) {
    return delays(timers(std::vector<std::int64_t>(starts, 20 * kMillisecond)));
  };
  const std::size_t needed = after(1).starts_needed;
  ASSERT_GT(needed, 1U);
  ASSERT_LT(needed, 10U);
  EXPECT_FALSE(after(needed - 1).watched);
  EXPECT_TRUE(after(needed).watched);
}

TEST(Relations, TimersThatDoNotAgreeAreNotWatchedAfterAnyNumberOfStarts) {
  std::vector<std::int64_t> phases;
  for (std::int64_t start = 0; start < 20; ++start) {
    phases.push_back((start * 37 % 100) * kMillisecond);
  }
  const Relation relation = delays(timers(phases));
  EXPECT_EQ(relation.starts, 20U);
  EXPECT_GT(relation.spread, 0.8);
  EXPECT_FALSE(relation.watched);
}

TEST(Relations, AStartWithFewEventsSaysNothing) {
  const Events full =
      together({timer(kA, 0, kLength, kPeriod), timer(kB, 20 * kMillisecond, kLength, kPeriod)});
  const Events few = without(full, [](const Event& event) { return event.stamp >= kSecond / 2; });
  const Statistics counts = countsOf({full, later(few), later(full, 2 * kStart)}, 2);
  EXPECT_EQ(delays(counts).starts, 2U);
}

TEST(Relations, APhaseAroundZeroIsAsNarrowAsAnyOther) {
  // B comes a little before A or a little after it: delays near 0 and near a period.
  Events answered;
  for (const Event& event : timer(kA, kPeriod, kLength, kPeriod)) {
    const std::int64_t late = answered.size() % 2 == 0 ? kMillisecond : -kMillisecond;
    answered.push_back({event.stamp + late, kB});
  }
  const Statistics counts = countsOf({together({timer(kA, 0, kLength, kPeriod), answered})}, 2);
  ASSERT_GT(counts.delays(kA, kB)[log_bins::bin(kMillisecond)], 200U);
  ASSERT_GT(counts.delays(kA, kB)[log_bins::bin(99 * kMillisecond)], 200U);
  EXPECT_LT(delays(counts).spread, 0.1);
  Events hiccups = timer(kB, 20 * kMillisecond, kLength, kPeriod);
  for (std::size_t k = 0; k < hiccups.size(); k += 50) {
    hiccups[k].stamp += 50 * kMillisecond;
  }
  const Events asked = timer(kA, 0, kLength, kPeriod);
  EXPECT_LT(delays(countsOf({together({asked, hiccups})}, 2)).spread, 0.1) << "they widen none";
}

TEST(Relations, WhoComesLateInAPeriodMayBeTheOneThatAsks) {
  const Statistics soon = timers(std::vector<std::int64_t>(8, 30 * kMillisecond));
  const Statistics late = timers(std::vector<std::int64_t>(8, 80 * kMillisecond));
  EXPECT_TRUE(delays(soon).watched);
  EXPECT_FALSE(delays(soon, kNoGraph, kB, kA).watched);
  EXPECT_FALSE(delays(late).watched);
  EXPECT_EQ(delays(late).starts_needed, 0U) << "no number of starts helps";
  EXPECT_TRUE(delays(late, connected("/x")).watched);
}

TEST(Relations, AMessageThatGetsThereIsAReason) {
  const Statistics counts = timers({20 * kMillisecond, 20 * kMillisecond});
  ASSERT_FALSE(delays(counts).watched);
  const Relation there = delays(counts, connected("/x"));
  EXPECT_TRUE(there.reaches && there.watched);
  const Relation back = delays(counts, connected("/x"), kB, kA);
  EXPECT_FALSE(back.reaches || back.watched) << "B's messages do not get to A";
  EXPECT_FALSE(delays(counts, connected("/other")).reaches) << "it hears another topic";
  // Of one node, of which nothing else is known.
  const EventType other_topic{"/a", "/y", "T"};
  EXPECT_TRUE(delays(countsOf({}, {kTypes[kA], other_topic})).reaches);
  EXPECT_FALSE(delays(countsOf({}, {{"", "/x", "T"}, {"", "/y", "T"}})).reaches)
      << "who sends is not known";
}

TEST(Relations, WhatEverybodyHearsIsNoReason) {
  const Statistics counts = timers({20 * kMillisecond, 20 * kMillisecond});
  EXPECT_TRUE(delays(counts, connected("/x", 3)).reaches);
  SourceGraph many = connected("/x", 6);
  EXPECT_FALSE(delays(counts, many).reaches);
  for (int k = 0; k < 10; ++k) {  // now it is a small part of all
    many.connect("/c", "/z", "/more" + std::to_string(k));
  }
  EXPECT_TRUE(delays(counts, many).reaches);
  for (const std::string topic : {"/tf", "/tf_static", "/clock"}) {
    const Statistics common = followed(1, {{"/a", topic, "T"}, kTypes[kB]});
    EXPECT_FALSE(delays(common, connected(topic)).reaches) << topic;
  }
}

TEST(Relations, AnIrregularTriggerIsAReason) {
  const Relation relation = delays(followed(1));
  EXPECT_TRUE(relation.irregular);
  EXPECT_FALSE(relation.watched) << "one start is not enough yet";
  EXPECT_EQ(relation.starts_needed, 2U);
  EXPECT_TRUE(delays(followed(2)).watched);
  EXPECT_TRUE(delays(followed(1), connected("/x")).watched) << "both reasons are enough";
  const Events unrelated =
      together({irregular(kA, 0, kLength, kPeriod, 1), irregular(kB, 0, kLength, kPeriod, 2)});
  EXPECT_FALSE(delays(countsOf({unrelated}, 2)).irregular);
}

// Requests at random, about every 4 s, each with its answer.
Events requests(unsigned seed) {
  return irregular(kA, 0, 400 * kSecond, 4 * kSecond, seed);
}

TEST(Relations, ADeadlineNeedsAnAnswerThatTakesItsTime) {
  const Events asked = requests(1);
  const Statistics counts =
      countsOf({together({asked, answers(kB, asked, 100 * kMillisecond)})}, 2);
  EXPECT_TRUE(isOwed(counts));
  EXPECT_TRUE(isOwed(counts, connected("/x")));
  EXPECT_FALSE(isOwed(counts, connected("/other"))) << "no message gets there";
  // Two that answer to the same come now in this order, now in that.
  Events first;
  Events second;
  for (const Event& event : asked) {
    const bool a_is_first = first.size() % 2 == 0;
    first.push_back({event.stamp + (a_is_first ? 0 : 500) * kMillisecond, kA});
    second.push_back({event.stamp + (a_is_first ? 3 : 450) * kMillisecond, kB});
  }
  EXPECT_FALSE(isOwed(countsOf({together({first, second})}, 2)));
}

TEST(Relations, WhatComesAsOftenAsByChanceIsNotOwed) {
  EXPECT_FALSE(isOwed(countsOf({atRandom(2, 0, 400 * kSecond, 4 * kSecond, 1)}, 2)));
  // A timer's own period says as much as what it answers to.
  const Statistics regular = timers({20 * kMillisecond, 20 * kMillisecond, 20 * kMillisecond});
  EXPECT_FALSE(isOwed(regular));
  EXPECT_FALSE(isOwed(regular, connected("/x")));
}

TEST(Relations, WhoComesOnlyInTheMiddleOfRecordingsIsSilentBeforeAndAfter) {
  // Both are regular while they come: no gap of B is longer than one of A.
  const auto isOwedFrom = [](std::int64_t begin) {
    const Events asked = timer(kA, begin, 400 * kSecond - begin, kPeriod);
    return isOwed(countsOf({together({asked, answers(kB, asked, 20 * kMillisecond),
                                      timer(kC, 0, 400 * kSecond, kSecond)})},
                           3),
                  connected("/x"));
  };
  EXPECT_TRUE(isOwedFrom(100 * kSecond));
  EXPECT_FALSE(isOwedFrom(0));
  EXPECT_FALSE(isOwedFrom(10 * kSecond)) << "it started late, and may always come";
}

// A tracker at 10 Hz that pauses with what it answers to, and leaves out one in a hundred.
Statistics pausing() {
  Events asked;
  for (std::int64_t burst = 0; burst < 10; ++burst) {
    const Events more =
        timer(kA, burst * 44 * kSecond, (burst * 44 + 40) * kSecond, 100 * kMillisecond);
    asked.insert(asked.end(), more.begin(), more.end());
  }
  std::size_t number = 0;
  const Events answered = without(asked, [&](const Event&) { return number++ % 100 == 0; });
  return countsOf({together({asked, answers(kB, answered, 20 * kMillisecond)})}, 2);
}

TEST(Relations, WhoPausesOwesAnswersThoughItSeldomMissesByChance) {
  const Statistics counts = pausing();
  const Relations relations(counts, kNoGraph, kTuning);
  EXPECT_LT(relations.missRateByChance(kA, kB), kTuning.least_chance_misses);
  EXPECT_TRUE(relations.owed(kA, kB).watched);
  Tuning strict;
  strict.rare = strict.least_chance_misses;
  EXPECT_FALSE(Relations(counts, kNoGraph, strict).owed(kA, kB).watched);
}

TEST(Relations, WhatANodeSaysAtItsNextStartIsNoAnswerToItsLastEnd) {
  const std::vector<EventType> one_node{{"/a", "/end", "T"}, {"/a", "/begin", "T"}};
  const std::vector<EventType> two_nodes{{"/a", "/end", "T"}, {"/b", "/begin", "T"}};
  const Events ends = requests(1);
  const Events at_once = together({ends, answers(kB, ends, 100 * kMillisecond)});
  const Events later = together({ends, answers(kB, ends, 2200 * kMillisecond)});
  EXPECT_TRUE(isOwed(countsOf({at_once}, one_node)));
  EXPECT_TRUE(isOwed(countsOf({later}, two_nodes)));
  EXPECT_FALSE(isOwed(countsOf({later}, one_node)));
}

}  // namespace
}  // namespace self_awareness::core::evidence
