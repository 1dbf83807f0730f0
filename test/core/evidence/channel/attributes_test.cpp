// The channels of attributes, from the events to the alarm (docs/method.md, section 3.10).

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "../judged.h"
#include "../recordings.h"
#include "../tracks.h"
#include "self_awareness/core/evidence/limits/coverage.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::int64_t kLength = 200 * kSecond;
constexpr std::int64_t kFault = 60 * kSecond;  // after the start of a recording

/// Two sources, the second of which is always healthy.
Events robot(const Source& source, unsigned seed, std::int64_t length = kLength) {
  const std::int64_t start = (seed + 1) * kStart;
  return together({messages(kA, start, start + length, source, seed),
                   messages(kB, start + 7 * kMillisecond, start + length, {}, seed + 100)});
}

/// Contents that change for minutes change always, so that recordings may be short.
Tuning withFrozen() {
  Tuning tuning;
  tuning.changing_time = 300;
  return tuning;
}

/// A model of recordings, each of a start of its own.
std::shared_ptr<const core::Model> learned(const std::vector<Events>& recordings,
                                           const Tuning& tuning = withFrozen()) {
  return std::make_shared<core::Model>(learnedFrom({kTypes[kA], kTypes[kB]}, recordings, tuning));
}

/// Four starts of a robot.
/// @param start its events, by its seed
template <typename Start>
std::vector<Events> fourStarts(const Start& start) {
  return {start(0), start(1), start(2), start(3)};
}

std::shared_ptr<const core::Model> learned(const Source& source) {
  return learned(fourStarts([&](unsigned seed) { return robot(source, seed); }));
}

bool watches(const core::Model& model, const std::string& channel, EventId id = kA) {
  const std::size_t track = indexOf(model.watched.tracks, channel, id, id);
  return track < model.watched.tracks.size() && !std::isnan(model.limits()->tracks[track]);
}

/// What is not judged of the topics of a model.
std::vector<Coverage::Blind> blindIn(const core::Model& model) {
  std::vector<Coverage::Blind> all;
  for (const Coverage& of :
       coverageOf(Model(model.watched), *model.limits(), {}, model.window, false)) {
    all.insert(all.end(), of.blind.begin(), of.blind.end());
  }
  return all;
}

std::optional<Begun> alarmIn(const core::Model& model, const Events& events) {
  return evidence::alarmIn(model.makeJudge(), events);
}

/// Changes what all messages of the first source say.
template <typename Change>
std::vector<Events> recordingsWhere(Change change) {
  return fourStarts([&](unsigned seed) {
    Events events = robot({}, seed);
    std::size_t number = 0;
    for (Event& event : events) {
      if (event.id == kA) {
        change(event, number++);
      }
    }
    return events;
  });
}

/// Seconds from the fault to the alarm.
double latency(const Begun& alarm, const Events& events) {
  return toSeconds(alarm.time - events.front().stamp - kFault);
}

/// Changes what the first source says from the fault on.
template <typename Change>
Events faulty(Events events, Change change) {
  const std::int64_t onset = events.front().stamp + kFault;
  for (Event& event : events) {
    if (event.id == kA && event.stamp >= onset) {
      change(event, event.stamp - onset);
    }
  }
  return events;
}

void expectNamed(const Begun& alarm, const std::string& channel, Kind kind) {
  EXPECT_EQ(alarm.evidence, channel);
  ASSERT_FALSE(alarm.suspects.empty());
  EXPECT_EQ(alarm.suspects[0].component, "/a");
  EXPECT_EQ(toString(alarm.suspects[0].reason.kind), toString(kind));
}

/// What may become wrong with the messages of a source.
struct Fault {
  std::string channel;
  Kind kind;
  std::string words;                                      // that tell of it, at first
  double periods;                                         // it is found within so many,
  double seconds;                                         // and so many seconds
  std::function<void(Attributes&, std::int64_t)> change;  // given the time since its begin [ns]
};

const std::vector<Fault> kFaults{
    {kAge, Kind::kStale, "stamps ", 2, 1.3,
     [](Attributes& each, std::int64_t since) {
       each.age = ageClass(toNanoseconds(0.02) + since);
     }},
    {kAge, Kind::kStale, "without a stamp", 0, 5,
     [](Attributes& each, std::int64_t) { each.age = Attributes::kZeroStamp; }},
    {kLost, Kind::kLossy, "", 10, 5,
     [](Attributes& each, std::int64_t since) {
       if (since / (100 * kMillisecond) % 2 == 0) {
         each.step = Attributes::Step::kLostOne;
       }
     }},
    {kSize, Kind::kOtherSize, "", 0, 5,
     [](Attributes& each, std::int64_t) { each.size = sizeClass(100); }},
    {kFrozen, Kind::kStuck, "the same content ", 0, 5,
     [](Attributes& each, std::int64_t) { each.same = true; }}};

/// A robot whose messages say nothing.
Events withoutAttributes(unsigned seed) {
  Events events = robot({}, seed);
  for (Event& event : events) {
    event.attributes = {};
  }
  return events;
}

TEST(Attributes, WhatBecomesWrongIsFoundSoonWhateverThePeriod) {
  Source source;
  source.size = 80000;
  source.spread = 0.5;
  for (const std::int64_t period : {33 * kMillisecond, 100 * kMillisecond, kSecond}) {
    source.period = period;
    const auto model = learned(source);
    for (const Fault& fault : kFaults) {
      SCOPED_TRACE(fault.channel + fault.words + " every " + std::to_string(period));
      const Events events = faulty(robot(source, 10), [&](Event& event, std::int64_t since) {
        fault.change(event.attributes, since);
      });
      const auto alarm = alarmIn(*model, events);
      ASSERT_TRUE(alarm);
      expectNamed(*alarm, fault.channel, fault.kind);
      EXPECT_GT(latency(*alarm, events), 0);
      EXPECT_LE(latency(*alarm, events), fault.periods * toSeconds(period) + fault.seconds);
      const std::string& words = alarm->suspects[0].reason.words;
      EXPECT_EQ(words.rfind(fault.words, 0), 0U) << words;
    }
  }
}

TEST(Lost, OnePercentIsMostlyFoundWithinHalfAMinute) {
  Source source;
  source.period = 50 * kMillisecond;
  const auto model = learned(source);
  int found = 0;
  for (unsigned seed = 10; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::bernoulli_distribution lost(0.01);
    const Events events = faulty(robot(source, seed), [&](Event& event, std::int64_t) {
      if (lost(random)) {
        event.attributes.step = Attributes::Step::kLostOne;
      }
    });
    const auto alarm = alarmIn(*model, events);
    ASSERT_TRUE(alarm);
    expectNamed(*alarm, kLost, Kind::kLossy);
    EXPECT_GT(latency(*alarm, events), 0);
    found += latency(*alarm, events) <= 30 ? 1 : 0;
  }
  EXPECT_GE(found, 15);
}

TEST(Attributes, NormalOperationIsQuiet) {
  Source source;
  source.spread = 1;
  source.period = 50 * kMillisecond;
  const auto model = learned(source);
  for (const char* channel : {kAge, kLost, kSize, kFrozen}) {
    EXPECT_TRUE(watches(*model, channel)) << channel;
  }
  for (unsigned seed = 10; seed < 20; ++seed) {
    EXPECT_FALSE(alarmIn(*model, robot(source, seed))) << seed;
  }
  EXPECT_FALSE(alarmIn(*model, robot(source, 20, 3600 * kSecond)));
}

TEST(Attributes, OneThatIsOddAndOlderRecordingsAndRestartsAreNoAlarm) {
  const auto model = learned(Source{});
  const std::vector<std::function<Attributes(const Attributes&, std::int64_t)>> changes{
      [](const Attributes& usual, std::int64_t since) {
        return since < 100 * kMillisecond ? Attributes{ageClass(5 * kSecond), sizeClass(1),
                                                       Attributes::Step::kLostMany, true}
                                          : usual;
      },
      [](const Attributes& /*usual*/, std::int64_t /*since*/) { return Attributes{}; },
      [](Attributes each, std::int64_t since) {
        each.step =
            since / (100 * kMillisecond) % 20 == 0 ? Attributes::Step::kRestart : each.step;
        return each;
      }};
  for (std::size_t k = 0; k < changes.size(); ++k) {
    EXPECT_FALSE(alarmIn(*model, faulty(robot({}, 10), [&](Event& event, std::int64_t since) {
      event.attributes = changes[k](event.attributes, since);
    }))) << k;
  }
}

TEST(Attributes, AreOffWhereTrainingKnowsNothingOfThemAndOtherLimitsStay) {
  const auto model = learned(fourStarts(withoutAttributes));
  for (const char* channel : {kAge, kLost, kSize, kFrozen}) {
    EXPECT_FALSE(watches(*model, channel)) << channel;
  }
  EXPECT_FALSE(alarmIn(*model, robot({}, 10))) << "what is known now says nothing";
  const Limits without = *model->limits();
  Limits with = *learned(Source{})->limits();
  ASSERT_LT(without.tracks.size(), with.tracks.size());
  with.tracks.resize(without.tracks.size());
  expectSameLimits(without, with);
}

TEST(Attributes, AreOffWhereTrainingCannotTellWhatIsUsual) {
  using Change = std::function<void(Attributes&, std::size_t)>;
  using Step = Attributes::Step;
  const std::vector<std::pair<const char*, Change>> trainings{
      {kAge, [](Attributes& each, std::size_t) { each.age = Attributes::kNoAge; }},
      {kAge, [](Attributes& each, std::size_t) { each.age = Attributes::kZeroStamp; }},
      {kAge,  // stamps are those of something old
       [](Attributes& each, std::size_t number) {
         each.age = ageClass(static_cast<std::int64_t>(number % 100) * kSecond / 10);
       }},
      {kLost, [](Attributes& each, std::size_t) { each.step = Step::kSame; }},
      {kLost, [](Attributes& each, std::size_t) { each.step = Step::kLostFew; }},
      {kFrozen, [](Attributes& each, std::size_t) { each.same = true; }}};
  for (std::size_t k = 0; k < trainings.size(); ++k) {
    const auto& training = trainings[k];
    const auto model = learned(recordingsWhere(
        [&](Event& event, std::size_t number) { training.second(event.attributes, number); }));
    EXPECT_FALSE(watches(*model, training.first)) << k;
    EXPECT_TRUE(watches(*model, training.first, kB)) << k;
  }
}

TEST(Age, AClockThatIsWrongByHoursOrDriftsIsNoFault) {
  const auto model = learned(Source{});
  for (const double offset :
       {-30.0, -3.5, 5.0, 30.0, 900.0}) {  // -3.44 s and 30.05 s begin classes
    const Events events = robot({}, 10, 1000 * kSecond);
    const std::int64_t start = events.front().stamp;
    Events shifted = events;
    for (Event& event : shifted) {
      if (event.id == kA) {
        event.attributes.age =
            ageClass(toNanoseconds(0.02 + offset) + (event.stamp - start) / 10000);  // 100 ppm
      }
    }
    EXPECT_FALSE(alarmIn(*model, shifted)) << offset;
  }
}

TEST(Lost, WhoWasLuckyIsExpectedToLoseWhatOthersDo) {
  const auto recording = [](double lost, double of_other, unsigned seed, std::int64_t length) {
    Source source;
    source.period = 50 * kMillisecond;
    source.lost = lost;
    Source other;
    other.lost = of_other;
    const std::int64_t start = (seed + 1) * kStart;
    return together({messages(kA, start, start + length, source, seed),
                     messages(kB, start, start + length, other, seed + 100)});
  };
  for (const double of_other : {0.0, 0.009}) {
    const auto model =
        learned(fourStarts([&](unsigned seed) { return recording(0, of_other, seed, kLength); }));
    EXPECT_TRUE(watches(*model, kLost));
    EXPECT_EQ(alarmIn(*model, recording(0.005, 0, 10, 1000 * kSecond)).has_value(), of_other == 0);
  }
}

TEST(Lost, TheAlarmEndsSoonAfterTheLosses) {
  Source source;
  source.period = 50 * kMillisecond;
  const auto model = learned(source);
  const Events events = faulty(robot(source, 10), [](Event& event, std::int64_t since) {
    if (since < 20 * kSecond && since / (50 * kMillisecond) % 2 == 0) {
      event.attributes.step = Attributes::Step::kLostOne;
    }
  });
  int windows = 0;
  judge(model->makeJudge(), events,
        [&](const Verdict& verdict) { windows += verdict.alarm ? 1 : 0; });
  EXPECT_NEAR(windows * toSeconds(kWindow), 23.5, 3.5) << "the hold time is 5 s";
}

TEST(Size, IsOffWhereHalvesOfTheTrainingDiffer) {
  const auto model = learned(fourStarts([](unsigned seed) {
    Source source;
    source.size = seed % 2 == 0 ? 1000 : 100000;
    return robot(source, seed);
  }));
  EXPECT_FALSE(watches(*model, kSize));
  EXPECT_TRUE(watches(*model, kSize, kB));
}

TEST(Frozen, IsOffWhereTrainingRepeatedItselfForAWhileAndSaysSo) {
  // As a GPS without a fix: the same for 5 s, then something new at every message for 20 s.
  const auto model = learned(recordingsWhere(
      [](Event& event, std::size_t number) { event.attributes.same = number % 250 < 50; }));
  EXPECT_FALSE(watches(*model, kFrozen));
  EXPECT_TRUE(watches(*model, kFrozen, kB));
  const std::vector<Coverage::Blind> blind = blindIn(*model);
  ASSERT_EQ(blind.size(), 1U);
  EXPECT_EQ(blind[0].about, "content");
  EXPECT_EQ(blind[0].topic, "/x");
  EXPECT_EQ(blind[0].why, "it repeated for 5 s in training");
}

TEST(Frozen, MinutesOfTrainingDoNotSayThatContentsAlwaysChange) {
  const auto model = learned({robot({}, 0), robot({}, 1), robot({}, 2)}, Tuning{});
  EXPECT_FALSE(watches(*model, kFrozen));
  ASSERT_EQ(blindIn(*model).size(), 2U);
  EXPECT_EQ(blindIn(*model)[0].why, "0.2 h in 3 starts, 2 h in 3 are needed");
}

// What they leave out: pauses, and how sources start.

// A source that sends for a while, and then pauses.
constexpr std::int64_t kSends = 40 * kSecond;
constexpr std::int64_t kPauses = 30 * kSecond;

Events pausing(unsigned seed) {
  const std::int64_t start = (seed + 1) * kStart;
  const std::int64_t end = start + 5 * (kSends + kPauses);
  Events events = messages(kB, start + 7 * kMillisecond, end, {}, seed + 100);
  for (std::int64_t begin = start; begin < end; begin += kSends + kPauses) {
    events = together({events, messages(kA, begin, begin + kSends, {}, seed)});
  }
  return events;
}

TEST(Attributes, AnAlarmEndsWhenItsSourcePauses) {
  const auto model = learned(fourStarts(pausing));
  for (const Fault& fault : kFaults) {
    Events events = pausing(10);
    const std::int64_t pause = events.front().stamp + 2 * (kSends + kPauses) + kSends;
    const std::int64_t onset = pause - 4 * kSecond;
    for (Event& event : events) {
      if (event.id == kA && event.stamp >= onset && event.stamp < pause) {
        fault.change(event.attributes, event.stamp - onset);
      }
    }
    int before = 0;
    int after = 0;
    judge(model->makeJudge(), events, [&](const Verdict& verdict) {
      if (verdict.evidence.find(fault.channel) != std::string::npos) {
        ++(verdict.window->start < pause + kRateSpan ? before : after);
      }
    });
    EXPECT_GT(before, 10) << fault.channel;
    EXPECT_EQ(after, 0) << fault.channel;
  }
}

TEST(Lost, WhatIsLostFromPauseToPauseAddsUp) {
  const auto model = learned(fourStarts(pausing));
  Events events;
  std::int64_t last = 0;
  for (Event event : pausing(10)) {
    if (event.id == kA) {
      if (event.stamp % (5 * kSecond) < 2500 * kMillisecond) {
        continue;  // the network is down
      }
      if (last > 0 && event.stamp - last > kRateSpan) {
        event.attributes.step = Attributes::Step::kLostMany;
      }
      last = event.stamp;
    }
    events.push_back(event);
  }
  int lost = 0;
  judge(model->makeJudge(), events, [&](const Verdict& verdict) {
    lost += verdict.evidence.find(kLost) != std::string::npos ? 1 : 0;
  });
  EXPECT_GT(lost, 100);
}

double limitOf(const core::Model& model, const std::string& channel) {
  return model.limits()->tracks.at(indexOf(model.watched.tracks, channel, kA, kA));
}

TEST(Age, AFewMessagesMayLackAStamp) {
  for (const std::size_t every : {25U, 200U}) {
    const auto model = learned(recordingsWhere([&](Event& event, std::size_t number) {
      if (number % every == every - 1) {
        event.attributes.age = Attributes::kZeroStamp;
      }
    }));
    EXPECT_EQ(watches(*model, kAge), every == 200);
    if (every == 200) {
      EXPECT_LT(limitOf(*model, kAge), 1);
    }
  }
}

TEST(Frozen, APauseBetweenTwoThatAreTheSameIsNoReasonToSwitchItOff) {
  const auto model = learned(fourStarts([](unsigned seed) {
    const std::int64_t start = (seed + 1) * kStart;
    const Events first = messages(kA, start, start + 100 * kSecond, {}, seed);
    Events second = messages(kA, start + 131 * kSecond, start + kLength, {}, seed);
    second[0].attributes.same = true;
    return together({first, second, messages(kB, start, start + kLength, {}, seed + 100)});
  }));
  ASSERT_TRUE(watches(*model, kFrozen));
  EXPECT_LT(limitOf(*model, kFrozen), 4);
}

}  // namespace
}  // namespace self_awareness::core::evidence
