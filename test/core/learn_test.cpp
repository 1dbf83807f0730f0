#include "self_awareness/core/learn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "evidence/recordings.h"
#include "self_awareness/core/evidence/channel/watched.h"
#include "self_awareness/core/verdict/alarm.h"

namespace self_awareness::core {
namespace {

using evidence::halfOf;
using evidence::irregular;
using evidence::kA;
using evidence::kB;
using evidence::kMillisecond;
using evidence::kSecond;
using evidence::together;

constexpr std::int64_t kLength = 120 * kSecond;
const std::vector<EventType> kTypes{{"/a", "/x", "T"}, {"/b", "/y", "T"}};

Recording robot(unsigned seed, std::int64_t length = kLength) {
  Recording recording;
  recording.events = together({irregular(kA, 0, length, 100 * kMillisecond, seed),
                               irregular(kB, 0, length, 50 * kMillisecond, seed + 100)});
  for (Event& event : recording.events) {
    event.stamp += seed * 1000 * kSecond;
  }
  recording.name = "run_" + std::to_string(seed) + ".bag";
  return recording;
}

void addTypes(Learner& learner) {
  for (const EventType& type : kTypes) {
    learner.intern(type);
  }
}

Model learned(const std::vector<std::uint64_t>& fingerprints) {
  Learner learner;
  addTypes(learner);
  for (const std::uint64_t fingerprint : fingerprints) {
    Recording recording = robot(static_cast<unsigned>(fingerprint));
    recording.fingerprint = fingerprint;
    learner.add(recording);
  }
  Model model = learner.learn();
  EXPECT_EQ(learner.why(), "");
  return model;
}

TEST(Learner, AModelSaysWhatItWasLearnedFromAndHasLimits) {
  const Model model = learned({1, 2, 3, 4});
  EXPECT_EQ(model.detectors(), "evidence");
  EXPECT_EQ(model.vocabulary().types(), kTypes);
  ASSERT_EQ(model.recordings.size(), 4U);
  EXPECT_EQ(model.recordings[2].bag, "run_3.bag");
  EXPECT_EQ(model.recordings[2].fingerprint, 3U);
  EXPECT_EQ(model.recordings[2].start / kSecond, 3000);
  EXPECT_GT(model.recordings[2].events, 3000U);
  ASSERT_TRUE(model.calibration);
  EXPECT_EQ(model.calibration->method, Calibration::kCrossFit);
  EXPECT_EQ(model.calibration->limits.tracks.size(), model.watched.tracks.size());
  EXPECT_TRUE(model.calibration->limits.firsts.empty()) << "all were trained on";
  EXPECT_EQ(model.calibration->budget, 0.5);
  EXPECT_GT(model.calibration->windows, 4000U);
  EXPECT_EQ(model.calibration->recordings.size(), 4U);
  EXPECT_EQ(model.findings.size(), 4U);
  for (const evidence::Coverage& component : model.coverage()) {
    EXPECT_TRUE(component.isWatched()) << component.component;
  }
}

TEST(Learner, IsTheSameAsItsStepsOneByOne) {
  const std::vector<std::uint64_t> fingerprints{1, 2, 4, 7};
  const Model model = learned(fingerprints);
  Learner learner;
  addTypes(learner);
  for (const std::uint64_t fingerprint : fingerprints) {
    Recording recording = robot(static_cast<unsigned>(fingerprint));
    recording.fingerprint = fingerprint;
    learner.count(recording);
  }
  const Model counts = learner.counts();
  EXPECT_FALSE(counts.isWatched());
  EXPECT_TRUE(model.evidence[0] == counts.evidence[0]);
  EXPECT_TRUE(model.evidence[1] == counts.evidence[1]);
  const evidence::CrossFit models(evidence::watch(counts.evidence[0], counts.evidence[1]));
  evidence::LimitFinder finder(models.model(), {});
  for (const std::uint64_t fingerprint : fingerprints) {
    finder.startRecording(models.judging(halfOf(fingerprint)));
    for (const Event& event : robot(static_cast<unsigned>(fingerprint)).events) {
      finder.add(event);
    }
  }
  finder.finish();
  const std::vector<double> limits = finder.find().limits.tracks;
  ASSERT_EQ(model.calibration->limits.tracks.size(), limits.size());
  for (std::size_t track = 0; track < limits.size(); ++track) {
    EXPECT_TRUE(model.calibration->limits.tracks[track] == limits[track] ||
                std::isnan(limits[track]));
  }
}

TEST(Learner, WhereAllRecordingsAreOfOneHalfEachIsJudgedInTwoParts) {
  const Model model = learned({2, 4});
  ASSERT_EQ(model.onlyHalf(), 0U);
  ASSERT_EQ(model.findings.size(), 4U);
  const std::int64_t middle = middleOf(robot(2).events);
  EXPECT_LT(model.findings[0].end, middle);
  EXPECT_GE(model.findings[1].start, middle - 5 * kSecond) << "the detector settles before it";
  EXPECT_LT(model.findings[1].start, middle);
  for (const auto& finding : model.findings) {
    EXPECT_TRUE(finding.trained_on);
  }
}

TEST(Learner, TooLittleIsAModelWithoutLimitsThatSaysWhy) {
  Learner learner;
  addTypes(learner);
  learner.add(robot(1, 20 * kSecond));
  const Model model = learner.learn();
  EXPECT_FALSE(model.calibration);
  EXPECT_NE(learner.why().find("too little normal operation"), std::string::npos) << learner.why();
  EXPECT_TRUE(model.isWatched()) << "the counts are not lost";
  EXPECT_THROW(learner.learn(), std::logic_error);
  EXPECT_THROW(learner.add(robot(2)), std::logic_error);
  EXPECT_THROW(learner.intern(kTypes[0]), std::logic_error);
}

TEST(Learner, ForThePapersDetectorThereAreNoLimits) {
  Learner::Parameters parameters;
  parameters.counting.evidence = false;
  parameters.counting.paper = true;
  Learner learner(parameters, {});
  addTypes(learner);
  learner.add(robot(1));
  const Model model = learner.learn();
  EXPECT_EQ(model.detectors(), "paper");
  EXPECT_FALSE(model.limits());
  EXPECT_NE(learner.why(), "");
}

TEST(Learner, RefusesWhatIsNoRecording) {
  Learner learner;
  EXPECT_THROW(learner.add({}), std::invalid_argument);
  EXPECT_THROW(learner.learn(), std::logic_error);
  Learner::Parameters parameters;
  parameters.limits.settle_time = -1;
  EXPECT_THROW(Learner(parameters, {}), std::invalid_argument);
}

TEST(Calibrator, RecordingsThatWereNotTrainedOnSayWhenATypeComesFirst) {
  Model model = learned({1, 2, 3, 4});
  Calibrator calibrator(model, {});
  calibrator.merge(model.findings);
  Recording late = robot(5);
  const std::int64_t start = late.events.front().stamp;
  late.events.erase(std::remove_if(late.events.begin(), late.events.end(),
                                   [&](const Event& event) {
                                     return event.id == kB && event.stamp < start + 3 * kSecond;
                                   }),
                    late.events.end());
  late.events.push_back({late.events.back().stamp, 7});  // an unknown event
  const std::unique_ptr<Calibrator> part = calibrator.part();
  part->addHeldOut(late);
  calibrator.merge(part->findings());
  calibrator.addHeldOut(robot(6));
  const Calibration found = calibrator.find();
  EXPECT_EQ(found.method, Calibration::kHeldOut);
  ASSERT_EQ(found.limits.firsts.size(), 2U);
  EXPECT_LT(found.limits.firsts[kA], kSecond);
  EXPECT_GE(found.limits.firsts[kB], 3 * kSecond) << "the latest of the two";
  EXPECT_LT(found.limits.firsts[kB], 4 * kSecond);
  Recording without = robot(7);
  without.events.erase(std::remove_if(without.events.begin(), without.events.end(),
                                      [](const Event& event) { return event.id == kB; }),
                       without.events.end());
  calibrator.addHeldOut(without);
  EXPECT_EQ(calibrator.find().limits.firsts[kB], -1) << "it does not always come";
}

TEST(Calibrator, AfterAStepOfTheClockFirstEventsCountFromThere) {
  const Model model = learned({1, 2, 3, 4});
  Calibrator calibrator(model, {});
  Recording stepped = robot(5, 200 * kSecond);
  const std::int64_t step = stepped.events.front().stamp + 100 * kSecond;
  stepped.events.erase(
      std::remove_if(stepped.events.begin(), stepped.events.end(),
                     [&](const Event& event) { return event.id == kB && event.stamp < step; }),
      stepped.events.end());
  for (Event& event : stepped.events) {
    event.stamp += event.stamp >= step ? 3600 * kSecond : 0;
  }
  const auto first = std::find_if(stepped.events.begin(), stepped.events.end(),
                                  [&](const Event& event) { return event.stamp >= step; });
  stepped.clock_steps = ClockSteps({first->stamp});
  calibrator.addHeldOut(stepped);
  ASSERT_EQ(calibrator.findings().size(), 2U);
  EXPECT_TRUE(calibrator.findings()[0].firsts.empty());
  EXPECT_LT(calibrator.findings()[1].firsts.at(kA), kSecond);
  EXPECT_GE(calibrator.findings()[1].firsts.at(kB), 0);
  EXPECT_LT(calibrator.findings()[1].firsts.at(kB), kSecond) << "not the hour of the step";
}

TEST(Model, KnowsStrangersIfItIsToldOfTheirTypes) {
  const Model model = learned({1, 2, 3, 4});
  const auto heard = std::make_shared<Vocabulary>(model.vocabulary());
  const EventId stranger = heard->intern({"/c", "/x", "T"});
  Recording told = robot(9);
  const std::int64_t middle = middleOf(told.events);
  told.events.insert(std::find_if(told.events.begin(), told.events.end(),
                                  [&](const Event& event) { return event.stamp >= middle; }),
                     {middle, stranger});
  Alarms alarms;
  std::optional<Alarm> found;
  Detector detector(model.makeJudge(heard), model.window, {}, [&](const Verdict& verdict) {
    alarms.add(verdict, model.window, *heard);
    found = found ? found : alarms.standing();
  });
  for (const Event& event : told.events) {
    detector.add(event);
  }
  detector.finish();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, Kind::kStranger);
  EXPECT_EQ(found->culprit, "/c");
}

TEST(Model, WhatWasLearnedJudgesAnotherRecording) {
  const Model model = learned({1, 2, 3, 4});
  Recording dead = robot(9);
  const std::int64_t death = dead.events.front().stamp + 60 * kSecond;
  dead.events.erase(
      std::remove_if(dead.events.begin(), dead.events.end(),
                     [&](const Event& event) { return event.id == kA && event.stamp > death; }),
      dead.events.end());
  Alarms alarms;
  std::vector<Alarm> found;
  Detector detector(model.makeJudge(), model.window, {}, [&](const Verdict& verdict) {
    alarms.add(verdict, model.window, model.vocabulary());
    if (verdict.alarm && verdict.changed) {
      found.push_back(*alarms.standing());
    }
  });
  for (const Event& event : dead.events) {
    detector.add(event);
  }
  detector.finish();
  ASSERT_EQ(found.size(), 1U) << "a pause of the other one is no silence of all";
  EXPECT_EQ(found[0].culprit, "/a");
  EXPECT_EQ(found[0].kind, Kind::kSilent);
  EXPECT_GT(found[0].begin, death);
  EXPECT_LT(found[0].begin, death + 3 * kSecond);
}

}  // namespace
}  // namespace self_awareness::core
