#include "self_awareness/core/evidence/limits/limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "../../../problem.h"
#include "../tracks.h"
#include "self_awareness/core/evidence/limits/cross_fit.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kPeriod = 200 * kMillisecond;
const std::int64_t kShortestPart = toNanoseconds(Tuning{}.shortest_part);
const std::int64_t kLeastTime = toNanoseconds(Tuning{}.least_time);

// A comes irregularly, B follows it after a delay, and C comes at random.
Events robot(std::int64_t length, unsigned seed, std::int64_t delay = 20 * kMillisecond) {
  return together(
      {followed(seed, length, delay), irregular(kC, 0, length, 50 * kMillisecond, seed + 100)});
}

std::shared_ptr<const Model> modelOf(const Events& first, const Events& second) {
  return std::make_shared<Model>(watch(countsOf({first}), countsOf({second})));
}

class LimitFinderTest : public testing::Test {
 protected:
  static void feed(LimitFinder& finder, const std::shared_ptr<const Model>& model,
                   const Events& events) {
    finder.startRecording(model);
    addAll(finder, events);
    finder.finish();
  }
  static Limits limitsOf(const std::shared_ptr<const Model>& model, const Events& events,
                         double budget = LimitFinder::kBudget) {
    LimitFinder finder(model, {kWindow, 5 * kSecond});
    feed(finder, model, events);
    return finder.find(budget).limits;
  }
  double limit(const Limits& limits, const std::string& channel, EventId to, EventId from) const {
    const std::size_t track = indexOf(model_->tracks(), channel, to, from);
    EXPECT_LT(track, model_->tracks().size());
    return limits.tracks.at(track);
  }
  /// The limit of a silence, by two starts that were trained on and a third one [s].
  double silence(const Events& first, const Events& second, const Events& third, EventId id = kA) {
    model_ = modelOf(first, later(second));
    return limit(limitsOf(model_, later(third, 2 * kStart)), kOverdue, id, id);
  }
  /// The same of starts that are alike.
  double silence(const Events& all) { return silence(all, all, all); }

  std::shared_ptr<const Model> model_ =
      modelOf(robot(100 * kSecond, 1), later(robot(100 * kSecond, 2)));
};

// A timer with a hole.
Events broken(EventId id, std::int64_t end, std::int64_t hole, std::int64_t lasts) {
  return together({timer(id, 0, hole, kPeriod), timer(id, hole + lasts, end, kPeriod)});
}

// A talks for some seconds now and then, and B all the time.
Events joystick(const std::vector<std::int64_t>& bursts, std::int64_t length) {
  Events events = timer(kB, 0, length, kPeriod);
  for (const std::int64_t burst : bursts) {
    events = together({events, timer(kA, burst, burst + 5 * kSecond, 50 * kMillisecond)});
  }
  return events;
}

TEST_F(LimitFinderTest, HoweverLongWhoPausesIsJudged) {
  const Events first = joystick({0, 20 * kSecond, 80 * kSecond, 120 * kSecond}, 200 * kSecond);
  const Events second = joystick({10 * kSecond, 60 * kSecond, 150 * kSecond}, 200 * kSecond);
  const double found = silence(first, second, first);
  EXPECT_GT(found, 3 * 85) << "few pauses say little of the longest";
  EXPECT_LT(found, 3600);
  EXPECT_LT(silence(first, second, first, kB), 1);
}

TEST_F(LimitFinderTest, PausesThatAreAlikeSayHowLongTheyGetHoweverLongTheyAre) {
  // It pauses for about 30 s.
  const auto every_half_minute = [](std::int64_t from, std::int64_t length) {
    std::vector<std::int64_t> bursts;
    for (std::int64_t burst = from; burst < length; burst += 35 * kSecond) {
      bursts.push_back(burst);
    }
    return joystick(bursts, length);
  };
  for (const std::int64_t length : {200 * kSecond, 1000 * kSecond}) {
    const double found = silence(every_half_minute(0, length), every_half_minute(kSecond, length),
                                 every_half_minute(3 * kSecond, length));
    EXPECT_GT(found, 30);
    EXPECT_LT(found, 60);
  }
}

TEST_F(LimitFinderTest, PausesOfOneStartMayBeHiccupsOfItsHost) {
  // Up to 1.2 s, a dozen times.
  const Events hiccups =
      without(timer(kA, 0, 200 * kSecond, 100 * kMillisecond), [](const Event& event) {
        const std::int64_t into = event.stamp % (15 * kSecond);
        const std::int64_t number = event.stamp / (15 * kSecond);
        return into > 0 && into < number * 90 * kMillisecond;
      });
  const auto limit_of = [&](std::int64_t apart) {
    model_ = modelOf(hiccups, later(hiccups, apart));
    const Limits limits = limitsOf(model_, later(hiccups, 2 * apart));
    return limit(limits, kOverdue, kA, kA);
  };
  const double longest = 1.2;
  EXPECT_NEAR(limit_of(210 * kSecond), 2 * longest, 0.1) << "all of one start";
  EXPECT_GT(limit_of(kStart), 2.4 * longest);
}

TEST_F(LimitFinderTest, StartsThatPauseAlikeSayMoreOfTheNextOne) {
  // Pauses of 2 to 20 s, or all of them by a factor shorter.
  const auto pausing = [](std::int64_t shorter) {
    std::vector<std::int64_t> bursts;
    std::int64_t at = 0;
    for (std::size_t number = 0; at < 200 * kSecond; ++number) {
      bursts.push_back(at);
      at += (5 + std::array<std::int64_t, 5>{2, 20, 5, 14, 9}.at(number % 5) / shorter) * kSecond;
    }
    return joystick(bursts, 200 * kSecond);
  };
  // By what its own starts say, and by what is usual of robots.
  const auto limits_of = [&](std::int64_t second, std::int64_t third) {
    std::vector<double> limits;
    for (const double robots : {1.0, 1e6}) {
      Tuning tuning;
      tuning.several = robots;
      model_ = std::make_shared<Model>(
          watch(countsOf({pausing(1)}), countsOf({later(pausing(second))}), {}, tuning));
      limits.push_back(
          limit(limitsOf(model_, later(pausing(third), 2 * kStart)), kOverdue, kA, kA));
    }
    return limits;
  };
  const std::vector<double> alike = limits_of(1, 1);
  EXPECT_LT(alike[0], 0.9 * alike[1]);
  const std::vector<double> different = limits_of(3, 9);
  EXPECT_GT(different[0], 1.02 * different[1]);
}

TEST_F(LimitFinderTest, WhoWasSilentThoughAskedIsWatchedForSilenceOnly) {
  // B answers A, but for a quarter of a minute.
  const auto pausing = [](unsigned seed, bool pauses) {
    return without(robot(200 * kSecond, seed), [&](const Event& event) {
      return pauses && event.id == kB && event.stamp > 100 * kSecond &&
             event.stamp < 115 * kSecond;
    });
  };
  for (const bool pauses : {false, true}) {
    model_ = modelOf(pausing(1, pauses), later(pausing(2, pauses)));
    const Limits limits = limitsOf(model_, later(pausing(3, pauses), 2 * kStart));
    EXPECT_EQ(std::isnan(limit(limits, kDeadlines, kB, kA)), pauses);
    EXPECT_FALSE(std::isnan(limit(limits, kOverdue, kB, kB)));
  }
}

TEST_F(LimitFinderTest, WhoTalkedOnceOnlyMayBeSilentForAsLong) {
  // No gap says that A pauses, but it is silent most of the time.
  EXPECT_GT(silence(joystick({100 * kSecond}, 200 * kSecond),
                    joystick({110 * kSecond}, 200 * kSecond), joystick({}, 100 * kSecond)),
            110);
}

TEST_F(LimitFinderTest, WhoNeverPausesMayStartLateAndEndEarly) {
  // A talks from some time on to another one, and B all the time.
  const auto runs = [](std::int64_t from, std::int64_t to) {
    return together({timer(kA, from * kSecond, to * kSecond, 50 * kMillisecond),
                     timer(kB, 0, 200 * kSecond, kPeriod)});
  };
  const double whole = silence(runs(0, 200));
  EXPECT_LT(whole, 0.5);
  for (const std::int64_t cut_off : {4, 14, 70}) {
    SCOPED_TRACE(cut_off);
    EXPECT_NEAR(silence(runs(cut_off, 200), runs(0, 200), runs(2 * cut_off, 200)), whole, 0.01);
    const Events ends_early = runs(0, 200 - cut_off);
    EXPECT_NEAR(silence(ends_early, runs(0, 200), ends_early), whole, 0.01);
  }
  EXPECT_NEAR(silence(runs(0, 200), runs(0, 200), runs(200, 200)), whole, 0.01)
      << "it was never started";
}

TEST_F(LimitFinderTest, WhoIsOftenSilentPausedWhereARecordingCutsOff) {
  // Its pauses are of 2 s, but for those that recordings begin or end with.
  const auto bursts_from = [](std::int64_t from) {
    return joystick({from, from + 7 * kSecond, from + 14 * kSecond}, 200 * kSecond);
  };
  EXPECT_GT(
      silence(bursts_from(90 * kSecond), bursts_from(80 * kSecond), bursts_from(5 * kSecond)),
      174);
}

TEST_F(LimitFinderTest, OneHoleOfOneRecordingIsNoLongPause) {
  const auto with_hole = [](std::int64_t lasts) {
    return together(
        {broken(kA, 200 * kSecond, 100 * kSecond, lasts), timer(kB, 0, 200 * kSecond, kPeriod)});
  };
  constexpr std::int64_t kHole = 15 * kSecond;
  const Events once = with_hole(kHole);
  EXPECT_NEAR(silence(once, with_hole(0), with_hole(0)), toSeconds(2 * kHole), 0.5);
  EXPECT_GT(silence(once, with_hole(0), once), toSeconds(4 * kHole)) << "it does so at times";
}

TEST_F(LimitFinderTest, WhatOneOfFiveStartsShowsAloneIsItsFault) {
  constexpr std::int64_t kHole = 9 * kSecond;
  const auto robot_with = [](std::int64_t hole) {  // twice, in one start
    return together({timer(kA, 0, 60 * kSecond, kPeriod),
                     timer(kA, 60 * kSecond + hole, 120 * kSecond, kPeriod),
                     timer(kA, 120 * kSecond + hole, 200 * kSecond, kPeriod),
                     timer(kB, 0, 200 * kSecond, kPeriod)});
  };
  model_ = modelOf(robot_with(kHole), later(robot_with(0)));
  const auto found = [&](int starts, std::int64_t hole) {  // two of them are those of the model
    LimitFinder finder(model_, {kWindow, 5 * kSecond});
    for (int start = 2; start < starts; ++start) {
      feed(finder, model_, later(robot_with(start == 2 ? hole : 0), start * kStart));
    }
    return finder.find();
  };
  const LimitFinder::Found five = found(5, 0);
  EXPECT_LT(limit(five.limits, kOverdue, kA, kA), 1);
  EXPECT_GT(limit(found(4, 0).limits, kOverdue, kA, kA), toSeconds(kHole))
      << "one of four may be what the robot does at times";
  EXPECT_GT(limit(found(5, kHole).limits, kOverdue, kA, kA), toSeconds(kHole))
      << "two starts show it";
  // The next start with a fault is an alarm, and that is said.
  model_ = modelOf(robot_with(0), later(robot_with(0)));
  EXPECT_GT(five.promised_rate, 1.5 * found(5, 0).promised_rate);
}

TEST_F(LimitFinderTest, WhatSeveralComponentsShowInOneStartIsNoHole) {
  // A and B are silent for 9 s in one of five starts, and C goes on: the robot stood.
  const auto start_with = [](std::int64_t stands) {
    return together({broken(kA, 100 * kSecond, 60 * kSecond, stands),
                     broken(kB, 100 * kSecond, 60 * kSecond, stands),
                     timer(kC, 0, 100 * kSecond, kPeriod)});
  };
  const auto limit_where = [&](double several) {
    Tuning tuning;
    tuning.several = several;
    model_ = std::make_shared<Model>(
        watch(countsOf({start_with(9 * kSecond)}), countsOf({later(start_with(0))}), {}, tuning));
    LimitFinder finder(model_, {kWindow, 5 * kSecond});
    for (int start = 2; start < 5; ++start) {
      feed(finder, model_, later(start_with(0), start * kStart));
    }
    return limit(finder.find().limits, kOverdue, kA, kA);
  };
  EXPECT_LT(limit_where(3), 1);
  EXPECT_GT(limit_where(2), 2 * 9);
}

TEST_F(LimitFinderTest, WhereSomeTimersLoseMessagesAllMayLoseOne) {
  const auto robot_that_loses = [](std::int64_t number) {
    return without(
        together({timer(kA, 0, 200 * kSecond, kSecond), timer(kB, 0, 200 * kSecond, kSecond)}),
        [=](const Event& event) {
          return event.id == kB && event.stamp >= 100 * kSecond &&
                 event.stamp < (100 + number) * kSecond;
        });
  };
  const auto silence_of_a = [&](std::int64_t number) {
    return silence(robot_that_loses(0), robot_that_loses(0), robot_that_loses(number));
  };
  EXPECT_LT(silence_of_a(0), 1.7);
  EXPECT_NEAR(silence_of_a(1), 2.05, 0.05);
  EXPECT_LT(silence_of_a(5), 1.9) << "a hole is no loss";
}

TEST_F(LimitFinderTest, WhatNumbersTellOfFastTimersIsOfSlowOnesToo) {
  // One of so many messages of B is missing. A lost none of 600.
  const auto silence_of_a_where = [&](std::int64_t one_in) {
    Events events = timer(kB, 0, 200 * kSecond, 50 * kMillisecond);
    for (std::size_t k = 0; k < events.size(); ++k) {
      const bool lost = static_cast<std::int64_t>(k) % one_in == one_in - 1;
      events[k].attributes.size = sizeClass(100);
      events[k].attributes.step = lost ? Attributes::Step::kLostOne : Attributes::Step::kNext;
    }
    events = together({timer(kA, 0, 200 * kSecond, kSecond), events});
    model_ = modelOf(events, later(events));
    return limit(limitsOf(model_, later(events, 2 * kStart)), kOverdue, kA, kA);
  };
  EXPECT_GE(silence_of_a_where(1000), 2) << "it may have been lucky";
  EXPECT_LT(silence_of_a_where(50), 1.7) << "it was not lucky so often: B sends too fast";
}

TEST_F(LimitFinderTest, LossesThatAreRareForSoManyMessagesAreNone) {
  // One of 40,000 messages of B is lost, and a budget that allows it.
  const std::int64_t length = 8000 * kSecond;
  Events loses = together({timer(kA, 0, length, kSecond), timer(kB, 0, length, kPeriod)});
  loses.erase(std::find_if(loses.begin(), loses.end(), [](const Event& event) {
    return event.id == kB && event.stamp >= 100 * kSecond;
  }));
  const Events training =
      together({timer(kA, 0, 100 * kSecond, kSecond), timer(kB, 0, 100 * kSecond, kPeriod)});
  model_ = modelOf(training, later(training));
  for (const double budget : {0.05, 50.0}) {
    const Limits limits = limitsOf(model_, later(loses, 2 * kStart), budget);
    EXPECT_EQ(limit(limits, kOverdue, kA, kA) >= 2, budget < 1);
  }
}

TEST_F(LimitFinderTest, ASmallerBudgetHasHigherLimits) {
  const Events normal = robot(200 * kSecond, 3);
  const Limits lax = limitsOf(model_, normal, 5);
  const Limits strict = limitsOf(model_, normal, 0.05);
  for (std::size_t track = 0; track < lax.tracks.size(); ++track) {
    EXPECT_FALSE(strict.tracks[track] < lax.tracks[track]) << track;
  }
  EXPECT_GT(limit(strict, kOverdue, kA, kA), limit(lax, kOverdue, kA, kA));
}

TEST_F(LimitFinderTest, APairThatMisleadsIsNotJudged) {
  const Limits holds = limitsOf(model_, robot(200 * kSecond, 3));
  EXPECT_TRUE(std::isfinite(limit(holds, kPairs, kB, kA)));
  // The phase held in both halves of the training by chance. It never does in another recording,
  // so there is no evidence, only less information.
  LimitFinder finder(model_, {kWindow, 5 * kSecond});
  feed(finder, model_, robot(200 * kSecond, 3));
  feed(finder, model_, robot(100 * kSecond, 4, 60 * kMillisecond));
  const Limits lost = finder.find().limits;
  EXPECT_TRUE(std::isnan(limit(lost, kPairs, kB, kA)));
  EXPECT_TRUE(std::isfinite(limit(lost, kOverdue, kB, kB))) << "what looks at one event type";
}

TEST_F(LimitFinderTest, LessThanTheLeastTimeIsTooLittle) {
  LimitFinder finder(model_, {kWindow, 5 * kSecond});
  // Two recordings, each with 5 s to settle: together they are a little too short.
  feed(finder, model_, robot(kLeastTime / 2 + 4 * kSecond, 3));
  feed(finder, model_, later(robot(kLeastTime / 2 + 4 * kSecond, 4)));
  EXPECT_THROW(finder.find(), std::invalid_argument);
  feed(finder, model_, later(robot(9 * kSecond, 5), 2 * kStart));
  EXPECT_NO_THROW(finder.find());
}

TEST_F(LimitFinderTest, WhatTheTrainingShowedDoesNotReplaceOtherRecordings) {
  const CrossFit models(
      watch(countsOf({robot(100 * kSecond, 1)}), countsOf({later(robot(100 * kSecond, 2))})));
  LimitFinder finder(models.model(), {kWindow, 5 * kSecond});
  feed(finder, models.judging(0), robot(100 * kSecond, 1));
  feed(finder, models.judging({}), later(robot(20 * kSecond, 3), 2 * kStart));
  EXPECT_THROW(finder.find(), std::invalid_argument);
  feed(finder, models.judging({}), later(robot(60 * kSecond, 4), 3 * kStart));
  EXPECT_NO_THROW(finder.find());
}

TEST_F(LimitFinderTest, AModelThatWatchesNothingIsSaidToBeTheReason) {
  model_ = modelOf(timer(kA, 0, 4 * kSecond, kSecond), timer(kA, 0, 4 * kSecond, kSecond));
  ASSERT_TRUE(model_->tracks().empty());
  EXPECT_TRUE(
      has(problemOf([&] { limitsOf(model_, robot(100 * kSecond, 3)); }), "train it on more"));
}

TEST_F(LimitFinderTest, WhatRecordingsSayElsewhereAddsUp) {
  // Pairs mislead in the second recording, and the third ends within a block.
  const std::vector<Events> recordings{robot(60 * kSecond, 3),
                                       robot(110 * kSecond, 4, 60 * kMillisecond),
                                       robot(19 * kSecond, 5), robot(45 * kSecond, 6)};
  const LimitFinder::Parameters parameters{kWindow, 5 * kSecond};
  LimitFinder alone(model_, parameters);
  LimitFinder sum(model_, parameters);
  std::vector<LimitFinder::Findings> elsewhere;
  for (const Events& recording : recordings) {
    feed(alone, model_, recording);
    LimitFinder part(model_, parameters);
    feed(part, model_, recording);
    elsewhere.push_back(part.findings());
  }
  std::reverse(elsewhere.begin(), elsewhere.end());
  for (const LimitFinder::Findings& findings : elsewhere) {
    sum.merge(findings);
  }
  EXPECT_EQ(sum.windows(), alone.windows());
  EXPECT_NEAR(sum.find().promised_rate, alone.find().promised_rate, 1e-12);
  const Limits limits = alone.find().limits;
  const auto isNone = [](double limit) { return std::isnan(limit); };
  EXPECT_TRUE(std::any_of(limits.tracks.begin(), limits.tracks.end(), isNone));
  EXPECT_FALSE(std::all_of(limits.tracks.begin(), limits.tracks.end(), isNone));
  expectSameLimits(limits, sum.find().limits);
}

TEST_F(LimitFinderTest, FindingsDoNotGrowWithTheRecordingAndSayWhatItDoes) {
  LimitFinder finder(model_, {kWindow, 5 * kSecond});
  for (const std::int64_t parts : {1, 4, 16, 17, 40}) {
    feed(finder, model_,
         without(robot(parts * kShortestPart + 5 * kSecond, 3), [](const Event& event) {
           return event.id == kA && event.stamp > 20 * kSecond && event.stamp < 21 * kSecond;
         }));
    const LimitFinder::Recording& recording = finder.findings().back();
    EXPECT_LE(recording.parts.size(), LimitFinder::kMostParts);
    EXPECT_GE(2 * recording.parts.size(), std::min<std::size_t>(parts, LimitFinder::kMostParts));
    std::uint64_t windows = 0;
    std::int64_t longest = 0;
    for (const LimitFinder::Recording::Part& part : recording.parts) {
      // All are of one length, but the last one.
      EXPECT_TRUE(&part == &recording.parts.back() ||
                  part.windows == recording.parts.front().windows);
      EXPECT_LE(part.windows, recording.parts.front().windows);
      EXPECT_EQ(part.evidence.size(), model_->tracks().size());
      windows += part.windows;
      longest = std::max(longest, part.longest_gaps.at(kA));
    }
    EXPECT_EQ(windows, recording.windows);
    EXPECT_GE(longest, kSecond) << "A was gone for so long";
    EXPECT_EQ(recording.said.size(), model_->tracks().size());
  }
}

TEST_F(LimitFinderTest, WithoutAReasonNoRelationIsJudged) {
  // All of one start: the answers may be chance, but a message can get from A to B.
  model_ = modelOf(robot(100 * kSecond, 1), robot(100 * kSecond, 2));
  const auto delay = [&](const SourceGraph& graph, const Events& events) {
    LimitFinder finder(model_, {kWindow, 5 * kSecond}, graph);
    feed(finder, model_, events);
    const LimitFinder::Found found = finder.find();
    for (std::size_t k = 0; k < model_->tracks().size(); ++k) {
      const Track& track = model_->tracks()[k];
      EXPECT_TRUE(found.relations[k].watched || track.to != track.from) << "its own history";
    }
    const Relation relation = found.relations.at(indexOf(model_->tracks(), kPairs, kB, kA));
    EXPECT_EQ(relation.watched, std::isfinite(limit(found.limits, kPairs, kB, kA)));
    return relation;
  };
  const Relation alone = delay({}, robot(200 * kSecond, 3));
  EXPECT_FALSE(alone.watched);
  EXPECT_EQ(alone.starts, 1U);
  EXPECT_EQ(alone.starts_needed, 2U) << "it is irregular";
  SourceGraph graph;
  graph.connect("/a", "/x", "/b");
  const Relation reached = delay(graph, robot(200 * kSecond, 3));
  EXPECT_TRUE(reached.watched && reached.reaches && reached.irregular);
  EXPECT_EQ(reached.starts_needed, 0U);
  const Relation other_start = delay({}, later(robot(100 * kSecond, 3)));
  EXPECT_EQ(other_start.starts, 2U) << "what was not trained on counts, too";
  EXPECT_TRUE(other_start.watched);
}

TEST_F(LimitFinderTest, RefusesImpossibleValues) {
  EXPECT_THROW(LimitFinder(model_, {0, 0}), std::invalid_argument);
  EXPECT_THROW(LimitFinder(model_, {kWindow, -1}), std::invalid_argument);
  for (const double budget : {0.0, -1.0, std::nan("")}) {
    EXPECT_THROW(limitsOf(model_, robot(200 * kSecond, 3), budget), std::invalid_argument);
  }
}

}  // namespace
}  // namespace self_awareness::core::evidence
