#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

#include "core/paper/delay_trainer.h"
#include "self_awareness/core/evidence/channel/watched.h"
#include "self_awareness/core/evidence/count/trainer.h"
#include "self_awareness/core/evidence/limits/cross_fit.h"
#include "self_awareness/core/learn.h"
#include "self_awareness/core/stream/mode.h"

namespace self_awareness::core {
namespace {

constexpr std::int64_t kPeriod = 50000000;  // [ns]
const EventType kType{"/a", "/x", "t"};
const EventType kOther{"/b", "/y", "t"};

Learner::Parameters counting(bool evidence, bool paper) {
  Learner::Parameters parameters;
  parameters.counting.evidence = evidence;
  parameters.counting.paper = paper;
  return parameters;
}

Recording recording(std::int64_t start, int events) {
  Recording recording;
  for (int i = 0; i < events; ++i) {
    recording.events.push_back({start + i * kPeriod, static_cast<EventId>(i % 2)});
  }
  return recording;
}

// The same, of the half that the fingerprint says.
Recording recording(std::int64_t start, int events, std::uint64_t fingerprint) {
  Recording of_half = recording(start, events);
  of_half.fingerprint = fingerprint;
  return of_half;
}

// Counts recordings in this order, each of so many events; those of 20 belong to the second half.
Model countsOf(const Learner::Parameters& parameters, const std::vector<int>& all) {
  Learner learner(parameters, {});
  learner.intern(kType);
  learner.intern(kOther);
  for (const int events : all) {
    learner.count(recording(events * 1000 * kPeriod, events, events == 20 ? 7 : 4));
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

TEST(LearnedCounts, TheOrderOfRecordingsDoesNotMatter) {
  const Model counts = threeRecordings(counting(true, true));
  for (const std::vector<int>& order : std::vector<std::vector<int>>{
           {10, 40, 20}, {20, 10, 40}, {20, 40, 10}, {40, 10, 20}, {40, 20, 10}}) {
    const Model other = countsOf(counting(true, true), order);
    EXPECT_TRUE(other.evidence == counts.evidence);
    EXPECT_TRUE(other.statistics == counts.statistics);
  }
}

TEST(LearnedCounts, AddUpToThoseOfOneLearner) {
  const std::vector<int> all{10, 20, 40};
  for (unsigned in_first = 0; in_first < 8; ++in_first) {
    std::vector<int> first;
    std::vector<int> second;
    for (std::size_t i = 0; i < all.size(); ++i) {
      (((in_first >> i) & 1U) != 0 ? first : second).push_back(all[i]);
    }
    if (first.empty() || second.empty()) {
      continue;
    }
    Model sum = countsOf(counting(true, false), first);
    const Model other = countsOf(counting(true, false), second);
    sum.add(other);
    EXPECT_TRUE(sum.evidence == threeRecordings(counting(true, false)).evidence) << in_first;
  }
  // Recordings of one half stay in two parts.
  Model sum = countsOf(counting(true, false), {10});
  const Model other = countsOf(counting(true, false), {40});
  sum.add(other);
  EXPECT_TRUE(sum.evidence == countsOf(counting(true, false), {10, 40}).evidence);
  EXPECT_EQ(eventsOf(sum.evidence[0]), 25U);
}

TEST(LearnedCounts, CountsWhatItsTrainersDo) {
  const Model counts = threeRecordings(counting(true, true));
  paper::DelayStatistics delays(paper::Binning{});
  evidence::Statistics half;
  for (const EventType& type : {kType, kOther}) {
    delays.intern(type);
    half.intern(type);
  }
  paper::DelayTrainer paper_trainer(delays);
  evidence::Trainer trainer(half, kDefaultWindow);
  for (const int events : {10, 20, 40}) {
    paper_trainer.startRecording();
    trainer.startRecording();
    for (const Event& event : recording(events * 1000 * kPeriod, events).events) {
      paper_trainer.add(event);
      if (events != 20) {
        trainer.add(event);
      }
    }
  }
  trainer.finish();
  EXPECT_TRUE(counts.statistics == delays);
  EXPECT_TRUE(counts.evidence[0] == half);
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
    learner.intern(kType);
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
  learner.intern(kType);
  learner.intern(kOther);
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
  learner.intern(kType);
  learner.intern(kOther);
  Recording part = recording(20 * kPeriod, 10, 4);
  part.since = 3 * kPeriod;
  part.before = {{5 * kPeriod, 1}, {6 * kPeriod, 1}};
  learner.count(part);
  const Model counts = learner.counts();
  EXPECT_EQ(eventsOf(counts.evidence[0]) + eventsOf(counts.evidence[1]), 10U);
  const auto& halves = counts.evidence;
  const auto& recordings = (halves[0].recordings().empty() ? halves[1] : halves[0]).recordings();
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
  part.graph.connect("/a", "/x", "/b");
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
  EXPECT_EQ(sum.graph.edges().size(), 1U);
  EXPECT_FALSE(sum.isWatched()) << "it was chosen by fewer counts";
}

TEST(CrossFit, AHalfIsJudgedByWhatTheOtherSays) {
  Learner learner(counting(true, false), {});
  learner.intern(kType);
  learner.intern(kOther);
  for (const int events : {200, 301}) {
    learner.count(recording(0, events, static_cast<std::uint64_t>(events)));
  }
  const Model counts = learner.counts();
  const evidence::Watched watched = evidence::watch(counts.evidence[0], counts.evidence[1]);
  const evidence::CrossFit cross_fit(watched);
  EXPECT_EQ(cross_fit.judging(std::nullopt), cross_fit.model());
  for (const std::size_t half : {0U, 1U}) {
    const evidence::Model other(
        watched, half == 0 ? evidence::Model::Learned::kSecond : evidence::Model::Learned::kFirst);
    EXPECT_EQ(cross_fit.judging(half)->logSurvival(0, 3 * kPeriod),
              other.logSurvival(0, 3 * kPeriod));
    EXPECT_NE(other.logSurvival(0, 3 * kPeriod), cross_fit.model()->logSurvival(0, 3 * kPeriod));
  }
  EXPECT_THROW(cross_fit.judging(2), std::out_of_range);
}

}  // namespace
}  // namespace self_awareness::core
