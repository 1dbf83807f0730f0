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

  std::shared_ptr<const Model> model_ =
      modelOf(robot(100 * kSecond, 1), later(robot(100 * kSecond, 2)));
};

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
  model_ = modelOf(first, later(second));
  const Limits limits = limitsOf(model_, later(first, 2 * kStart));
  const double found = limit(limits, kOverdue, kA, kA);
  EXPECT_GT(found, toSeconds(3 * 85 * kSecond)) << "few pauses say little of the longest";
  EXPECT_LT(found, 3600);
  EXPECT_LT(limit(limits, kOverdue, kB, kB), 1);
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
    model_ = modelOf(every_half_minute(0, length), later(every_half_minute(kSecond, length)));
    const Limits limits =
        limitsOf(model_, later(every_half_minute(3 * kSecond, length), 2 * kStart));
    EXPECT_GT(limit(limits, kOverdue, kA, kA), 30);
    EXPECT_LT(limit(limits, kOverdue, kA, kA), 60);
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
  model_ = modelOf(joystick({100 * kSecond}, 200 * kSecond),
                   later(joystick({110 * kSecond}, 200 * kSecond)));
  const Limits limits = limitsOf(model_, later(joystick({}, 100 * kSecond), 2 * kStart));
  EXPECT_GT(limit(limits, kOverdue, kA, kA), 110);
}

TEST_F(LimitFinderTest, WhoNeverPausesMayStartLateAndEndEarly) {
  // A talks from some time on to another one, and B all the time.
  const auto runs = [](std::int64_t from, std::int64_t to) {
    return together({timer(kA, from * kSecond, to * kSecond, 50 * kMillisecond),
                     timer(kB, 0, 200 * kSecond, kPeriod)});
  };
  const auto age_of = [&](const Events& first, const Events& second, const Events& third) {
    model_ = modelOf(first, later(second));
    const Limits limits = limitsOf(model_, later(third, 2 * kStart));
    return limit(limits, kOverdue, kA, kA);
  };
  const double whole = age_of(runs(0, 200), runs(0, 200), runs(0, 200));
  EXPECT_LT(whole, 0.5);
  for (const std::int64_t cut_off : {4, 14, 70}) {
    EXPECT_NEAR(age_of(runs(cut_off, 200), runs(0, 200), runs(2 * cut_off, 200)), whole, 0.01)
        << cut_off;
    EXPECT_NEAR(age_of(runs(0, 200 - cut_off), runs(0, 200), runs(0, 200 - cut_off)), whole, 0.01)
        << cut_off;
  }
  EXPECT_NEAR(age_of(runs(0, 200), runs(0, 200), runs(200, 200)), whole, 0.01)
      << "it was never started";
}

TEST_F(LimitFinderTest, WhoIsOftenSilentPausedWhereARecordingCutsOff) {
  // Its pauses are of 2 s, but for those that recordings begin or end with.
  const auto bursts_from = [](std::int64_t from) {
    return joystick({from, from + 7 * kSecond, from + 14 * kSecond}, 200 * kSecond);
  };
  model_ = modelOf(bursts_from(90 * kSecond), later(bursts_from(80 * kSecond)));
  const Limits limits = limitsOf(model_, later(bursts_from(5 * kSecond), 2 * kStart));
  EXPECT_GT(limit(limits, kOverdue, kA, kA), 174);
}

TEST_F(LimitFinderTest, OneHoleOfOneRecordingIsNoLongPause) {
  const auto with_hole = [](std::int64_t lasts) {
    return together({timer(kA, 0, 100 * kSecond, kPeriod),
                     timer(kA, 100 * kSecond + lasts, 200 * kSecond, kPeriod),
                     timer(kB, 0, 200 * kSecond, kPeriod)});
  };
  constexpr std::int64_t kHole = 15 * kSecond;
  model_ = modelOf(with_hole(kHole), later(with_hole(0)));
  const Limits once = limitsOf(model_, later(with_hole(0), 2 * kStart));
  EXPECT_NEAR(limit(once, kOverdue, kA, kA), toSeconds(2 * kHole), 0.5);
  const Limits twice = limitsOf(model_, later(with_hole(kHole), 2 * kStart));
  EXPECT_GT(limit(twice, kOverdue, kA, kA), toSeconds(4 * kHole)) << "it does so at times";
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
    return together({timer(kA, 0, 60 * kSecond, kPeriod),
                     timer(kA, 60 * kSecond + stands, 100 * kSecond, kPeriod),
                     timer(kB, 0, 60 * kSecond, kPeriod),
                     timer(kB, 60 * kSecond + stands, 100 * kSecond, kPeriod),
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
    model_ = modelOf(robot_that_loses(0), later(robot_that_loses(0)));
    return limit(limitsOf(model_, later(robot_that_loses(number), 2 * kStart)), kOverdue, kA, kA);
  };
  const double without = silence_of_a(0);
  const double with_loss = silence_of_a(1);
  EXPECT_LT(without, 1.7);
  EXPECT_GE(with_loss, 2);
  EXPECT_LT(with_loss, 2.1);
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

TEST_F(LimitFinderTest, ATimerThatLosesSingleMessagesHasNoLongTail) {
  const Events loses =
      without(timer(kA, 0, 200 * kSecond, 100 * kMillisecond), [](const Event& event) {
        return event.stamp == 80 * kSecond || event.stamp == 160 * kSecond;
      });
  model_ = modelOf(loses, later(loses));
  const Limits limits = limitsOf(model_, later(loses, 2 * kStart));
  const double found_after = limit(limits, kOverdue, kA, kA);
  EXPECT_GT(found_after, 0.35) << "two in a row are normal, too";
  EXPECT_LT(found_after, 0.6);
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

TEST_F(LimitFinderTest, CountsTheWindowsAfterSettling) {
  LimitFinder finder(model_, {kWindow, 5 * kSecond});
  const Events normal = timer(kA, 0, 60 * kSecond, kPeriod);
  feed(finder, model_, normal);
  EXPECT_EQ(finder.windows(), 548U);  // the recording ends before the last window does
  feed(finder, model_, normal);
  EXPECT_EQ(finder.windows(), 2 * 548U);
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

TEST_F(LimitFinderTest, FindingsDoNotGrowWithTheRecording) {
  LimitFinder finder(model_, {kWindow, 5 * kSecond});
  for (const std::int64_t parts : {1, 4, 16, 17, 40}) {
    feed(finder, model_, robot(parts * kShortestPart + 5 * kSecond, 3));
    const LimitFinder::Recording& recording = finder.findings().back();
    EXPECT_LE(recording.parts.size(), LimitFinder::kMostParts);
    EXPECT_GE(2 * recording.parts.size(), std::min<std::size_t>(parts, LimitFinder::kMostParts));
    std::uint64_t windows = 0;
    for (const LimitFinder::Recording::Part& part : recording.parts) {
      // All are of one length, but the last one.
      EXPECT_TRUE(&part == &recording.parts.back() ||
                  part.windows == recording.parts.front().windows);
      EXPECT_LE(part.windows, recording.parts.front().windows);
      EXPECT_EQ(part.evidence.size(), model_->tracks().size());
      EXPECT_EQ(part.longest_gaps.size(), model_->size());
      windows += part.windows;
    }
    EXPECT_EQ(windows, recording.windows);
    EXPECT_EQ(recording.said.size(), model_->tracks().size());
  }
}

TEST_F(LimitFinderTest, PartsTogetherSayWhatTheRecordingDoes) {
  const auto largestOf = [&](std::int64_t length) {
    LimitFinder finder(model_, {kWindow, 5 * kSecond});
    feed(finder, model_, without(robot(length, 3), [](const Event& event) {
           // A is gone for a second
           return event.id == kA && event.stamp > 50 * kSecond && event.stamp < 51 * kSecond;
         }));
    std::int64_t longest = 0;
    for (const LimitFinder::Recording::Part& part : finder.findings().at(0).parts) {
      longest = std::max(longest, part.longest_gaps[kA]);
    }
    return longest;
  };
  EXPECT_GE(largestOf(60 * kSecond), kSecond);
  EXPECT_GE(largestOf(40 * kShortestPart), largestOf(60 * kSecond));
}

TEST_F(LimitFinderTest, WithoutAReasonNoRelationIsJudged) {
  // All of one start: the answers may be chance, but a message can get from A to B.
  const Events normal = robot(200 * kSecond, 3);
  const auto delay = [&](const SourceGraph& graph, const Events& events) {
    const auto model = std::make_shared<Model>(
        watch(countsOf({robot(100 * kSecond, 1)}), countsOf({robot(100 * kSecond, 2)})));
    LimitFinder finder(model, {kWindow, 5 * kSecond}, graph);
    feed(finder, model, events);
    const std::size_t track = indexOf(model->tracks(), kPairs, kB, kA);
    EXPECT_LT(track, model->tracks().size());
    const LimitFinder::Found found = finder.find();
    EXPECT_EQ(found.relations.at(track).watched, std::isfinite(found.limits.tracks.at(track)));
    for (std::size_t k = 0; k < model->tracks().size(); ++k) {
      if (model->tracks()[k].to == model->tracks()[k].from) {
        EXPECT_TRUE(found.relations[k].watched) << "the own history needs no reason";
      }
    }
    return found.relations.at(track);
  };
  const Relation alone = delay({}, normal);
  EXPECT_FALSE(alone.watched);
  EXPECT_EQ(alone.starts, 1U);
  EXPECT_EQ(alone.starts_needed, 2U) << "it is irregular";
  SourceGraph graph;
  graph.connect("/a", "/x", "/b");
  const Relation reached = delay(graph, normal);
  EXPECT_TRUE(reached.watched);
  EXPECT_TRUE(reached.reaches && reached.irregular);
  EXPECT_EQ(reached.starts_needed, 0U);
  const Relation other_start = delay({}, later(robot(100 * kSecond, 3)));
  EXPECT_EQ(other_start.starts, 2U) << "what was not trained on counts, too";
  EXPECT_TRUE(other_start.watched);
}

TEST_F(LimitFinderTest, MoreHoursPromiseFewerFalseAlarms) {
  const auto promised = [&](unsigned starts) {
    LimitFinder finder(model_, {kWindow, 5 * kSecond});
    for (unsigned seed = 3; seed < 3 + starts; ++seed) {
      feed(finder, model_, later(robot(200 * kSecond, seed), seed * kStart));
    }
    return finder.find().promised_rate;
  };
  const double hours = 4 * 100.0 / 3600 + 12 * 195.0 / 3600;
  EXPECT_GE(promised(12), 0.57 / (0.5 + hours)) << "nobody can promise less after so many hours";
  EXPECT_LT(promised(12), promised(4));
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
