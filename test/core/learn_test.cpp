#include "self_awareness/core/learn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "evidence/recordings.h"
#include "self_awareness/core/evidence/channel/watched.h"
#include "self_awareness/core/stream/mode.h"

namespace self_awareness::core {
namespace {

using evidence::kA;
using evidence::kB;
using evidence::kMillisecond;
using evidence::kSecond;
using evidence::without;

constexpr std::int64_t kLength = 120 * kSecond;
const std::vector<EventType> kTypes{{"/a", "/x", "T"}, {"/b", "/y", "T"}};

Recording robot(unsigned seed, std::int64_t length = kLength) {
  Recording recording;
  recording.events = evidence::later(evidence::atRandom(2, 0, length, 50 * kMillisecond, seed),
                                     seed * evidence::kStart);
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
  late.events = without(late.events, [&](const Event& event) {
    return event.id == kB && event.stamp < start + 3 * kSecond;
  });
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
  Recording of_a = robot(7);
  of_a.events = without(of_a.events, [](const Event& event) { return event.id == kB; });
  calibrator.addHeldOut(of_a);
  EXPECT_EQ(calibrator.find().limits.firsts[kB], -1) << "it does not always come";
}

TEST(Calibrator, AfterAStepOfTheClockFirstEventsCountFromThere) {
  const Model model = learned({1, 2, 3, 4});
  Calibrator calibrator(model, {});
  Recording stepped = robot(5, 200 * kSecond);
  const std::int64_t step = stepped.events.front().stamp + 100 * kSecond;
  stepped.events = without(
      stepped.events, [&](const Event& event) { return event.id == kB && event.stamp < step; });
  for (Event& event : stepped.events) {
    event.stamp += event.stamp >= step ? 3600 * kSecond : 0;
  }
  const auto first = std::find_if(stepped.events.begin(), stepped.events.end(),
                                  [&](const Event& event) { return event.stamp >= step; });
  stepped.clock_steps = ClockSteps({first->stamp});
  calibrator.addHeldOut(stepped);
  ASSERT_EQ(calibrator.findings().size(), 2U);
  EXPECT_TRUE(calibrator.findings()[0].firsts.empty());
  for (const std::int64_t found : calibrator.findings()[1].firsts) {
    EXPECT_GE(found, 0);
    EXPECT_LT(found, kSecond) << "not the hour of the step";
  }
}

constexpr std::int64_t kPeriod = 50000000;  // [ns]

Learner::Parameters counting(bool evidence, bool paper) {
  Learner::Parameters parameters;
  parameters.counting.evidence = evidence;
  parameters.counting.paper = paper;
  return parameters;
}

// Of the half that the fingerprint says.
Recording recording(std::int64_t start, int events, std::uint64_t fingerprint = 0) {
  Recording recording;
  recording.fingerprint = fingerprint;
  for (int i = 0; i < events; ++i) {
    recording.events.push_back({start + i * kPeriod, static_cast<EventId>(i % 2)});
  }
  return recording;
}

// Counts recordings in this order, each of so many events; those of 20 belong to the second half.
Model countsOf(const Learner::Parameters& parameters, const std::vector<int>& all) {
  Learner learner(parameters, {});
  addTypes(learner);
  for (const int events : all) {
    learner.count(recording(std::int64_t{1000} * events * kPeriod, events, events == 20 ? 7 : 4));
  }
  return learner.counts();
}

// Learns from recordings of 10, 20 and 40 events.
Model threeRecordings(const Learner::Parameters& parameters) {
  return countsOf(parameters, {10, 20, 40});
}

std::uint64_t eventsOf(const evidence::Statistics& half) {
  return half.type(0).events + half.type(1).events;
}

TEST(LearnedCounts, RecordingsBelongToTheTwoHalvesByTheirFingerprint) {
  const Model counts = threeRecordings(counting(true, true));
  EXPECT_EQ(eventsOf(counts.evidence[0]), 50U);
  EXPECT_EQ(eventsOf(counts.evidence[1]), 20U);
  EXPECT_EQ(counts.statistics.events(), 70U);
  EXPECT_EQ(counts.onlyHalf(), std::nullopt);
}

TEST(LearnedCounts, AddUpToThoseOfOneLearner) {
  const Model whole = threeRecordings(counting(true, true));
  using Parts = std::vector<std::pair<std::vector<int>, std::vector<int>>>;
  for (const auto& [first, second] : Parts{{{10}, {20, 40}}, {{20}, {10, 40}}, {{20, 40}, {10}}}) {
    SCOPED_TRACE(first.front());
    Model sum = countsOf(counting(true, true), first);
    sum.add(countsOf(counting(true, true), second));
    EXPECT_TRUE(sum.evidence == whole.evidence);
    EXPECT_TRUE(sum.statistics == whole.statistics);
  }
  // Recordings of one half stay in two parts.
  Model sum = countsOf(counting(true, false), {10});
  sum.add(countsOf(counting(true, false), {40}));
  EXPECT_TRUE(sum.evidence == countsOf(counting(true, false), {10, 40}).evidence);
  EXPECT_EQ(eventsOf(sum.evidence[0]), 25U);
}

TEST(LearnedCounts, CountsOnlyForTheDetectorsAskedFor) {
  const Model both = threeRecordings(counting(true, true));
  const Model evidence = threeRecordings(counting(true, false));
  EXPECT_TRUE(evidence.evidence == both.evidence);
  EXPECT_EQ(evidence.statistics.pairs(), 0U);
  EXPECT_EQ(evidence.statistics.eventCount(0), both.statistics.eventCount(0));
  const Model paper = threeRecordings(counting(false, true));
  EXPECT_TRUE(paper.statistics == both.statistics);
  EXPECT_EQ(paper.evidence[0].size(), 0U);
  EXPECT_THROW(Learner(counting(false, false), {}), std::invalid_argument);
}

TEST(LearnedCounts, ThePaperKnowsNoModes) {
  for (const bool paper : {true, false}) {
    Learner learner(counting(true, paper), {});
    learner.intern(kTypes[0]);
    const EventId mode = learner.intern({"/b", "/y", typeOfMode("t", "DRIVING")});
    learner.count(recording(0, 100, 1));
    const Model counts = learner.counts();
    EXPECT_EQ(counts.statistics.eventCount(0), 50U);
    EXPECT_EQ(counts.statistics.eventCount(mode), 0U);
    EXPECT_EQ(counts.evidence[0].type(mode).events + counts.evidence[1].type(mode).events, 5U)
        << "that it ticks in 5 s";
  }
}

TEST(LearnedCounts, RecordingsOfOneHalfAreCutInTwo) {
  Learner learner(counting(true, true), {});
  addTypes(learner);
  learner.count(recording(0, 10, 3));
  const Model counts = learner.counts();
  EXPECT_EQ(counts.onlyHalf(), std::optional<std::size_t>(1));
  EXPECT_EQ(eventsOf(counts.evidence[0]), 5U);
  EXPECT_EQ(eventsOf(counts.evidence[1]), 5U);
  EXPECT_EQ(counts.evidence[1].type(0).gaps, 2U);  // the one over the cut ends in the second part
  EXPECT_EQ(counts.evidence[0].recordings().size() + counts.evidence[1].recordings().size(), 1U);
  EXPECT_THROW(learner.counts(), std::logic_error);
  EXPECT_THROW(learner.count(recording(0, 10)), std::logic_error);
}

TEST(LearnedCounts, OfWhatComesBeforeOnlyTheFirstTimesCount) {
  Learner learner;
  addTypes(learner);
  Recording part = recording(20 * kPeriod, 10, 4);
  part.since = 3 * kPeriod;
  part.before = {{5 * kPeriod, 1}, {6 * kPeriod, 1}};
  learner.count(part);
  const Model counts = learner.counts();
  EXPECT_EQ(eventsOf(counts.evidence[0]) + eventsOf(counts.evidence[1]), 10U);
  const bool in_second = counts.evidence[0].recordings().empty();
  const auto& recordings = counts.evidence.at(in_second ? 1 : 0).recordings();
  ASSERT_EQ(recordings.size(), 1U);
  EXPECT_EQ(recordings[0].firsts, (std::vector<std::int64_t>{17 * kPeriod, 2 * kPeriod}));
  EXPECT_EQ(counts.recordings[0].start, 20 * kPeriod);
}

TEST(LearnedCounts, WhatDoesNotFitIsNotAddedAndSaysWhy) {
  Learner::Parameters parameters = counting(true, false);
  Model sum = countsOf(parameters, {10});
  const Model whole = countsOf(parameters, {10, 20});
  parameters.counting.window *= 2;
  EXPECT_THROW(sum.add(countsOf(parameters, {20})), std::invalid_argument);
  EXPECT_THROW(sum.add(countsOf(counting(true, true), {20})), std::invalid_argument);
  Model part = countsOf(counting(true, false), {20});
  Model watched = part;
  watched.watch();
  watched.dropCounts();
  EXPECT_THROW(sum.add(watched), std::invalid_argument);
  ASSERT_EQ(sum.recordings.size(), 1U);
  sum.watch();
  sum.add(part);
  EXPECT_TRUE(sum.evidence == whole.evidence);
  EXPECT_TRUE(sum.statistics == whole.statistics);
  EXPECT_EQ(sum.recordings.size(), 2U);
  EXPECT_FALSE(sum.isWatched()) << "it was chosen by fewer counts";
}

TEST(LearnedCounts, OfTwoModelsWhatHoldsForBothIsKept) {
  const Learner::Parameters parameters = counting(true, false);
  Model sum = countsOf(parameters, {10});
  Model other = countsOf(parameters, {20});
  sum.graph.connect("/a", "/x", "/b");
  other.graph.connect("/a", "/x", "/b");
  other.graph.connect("/b", "/y", "/c");
  other.graph.place("/b", "base");
  other.graph.addUnheard({"/b", "/debug"});
  sum.graph.addLasting({"/b", "/x"}, 2);
  other.graph.addLasting({"/b", "/x"}, 1);
  sum.stamp = 3;
  other.stamp = 2;
  sum.tuning.least_effect = other.tuning.least_effect = 0.003;
  sum.tuning.without = other.tuning.without = {"slower"};
  const evidence::Tuning tuning = sum.tuning;
  sum.watch();
  sum.calibration = Calibration();
  sum.paper_calibration = paper::Calibration();
  sum.findings.resize(2);
  sum.add(other);
  EXPECT_EQ(sum.graph.hostOf("/b"), "base");
  EXPECT_EQ(sum.graph.unheard().size(), 1U);
  EXPECT_EQ(sum.graph.lasting().at({"/b", "/x"}), 3U) << "recordings that had it";
  EXPECT_EQ(sum.graph.edges().size(), 2U);
  EXPECT_EQ(sum.stamp, 3);
  EXPECT_FALSE(sum.limits() || sum.threshold());
  EXPECT_TRUE(sum.findings.empty()) << "what recordings showed to each other";
  sum.watch();
  EXPECT_TRUE(sum.tuning == tuning && sum.watched.tuning == tuning);
  other.tuning.without = {};
  sum.add(other);
  EXPECT_TRUE(sum.tuning == evidence::Tuning{}) << "where they differ, those of this version";
}

}  // namespace
}  // namespace self_awareness::core
