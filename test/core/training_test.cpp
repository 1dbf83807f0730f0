#include "self_awareness/core/training.h"

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
#include "self_awareness/core/stream/mode.h"

namespace self_awareness::core {
namespace {

constexpr std::int64_t kPeriod = 50000000;  // [ns]
const EventType kType{"/a", "/x", "t"};
const EventType kOther{"/b", "/y", "t"};

Training::Parameters counting(bool evidence, bool paper) {
  Training::Parameters parameters;
  parameters.evidence = evidence;
  parameters.paper = paper;
  return parameters;
}

std::vector<Event> recording(std::int64_t start, int events) {
  std::vector<Event> all;
  for (int i = 0; i < events; ++i) {
    all.push_back({start + i * kPeriod, static_cast<EventId>(i % 2)});
  }
  return all;
}

// By the half that it belongs to.
Training::Recording recordingOf(std::uint64_t fingerprint, std::int64_t middle = 0) {
  Training::Recording recording;
  recording.fingerprint = fingerprint;
  recording.middle = middle;
  return recording;
}

// Counts recordings in this order, each of so many events; those of 20 belong to the second half.
TrainingCounts countsOf(const Training::Parameters& parameters, const std::vector<int>& all) {
  Training training(parameters);
  training.intern(kType);
  training.intern(kOther);
  for (const int events : all) {
    const std::int64_t start = events * 1000 * kPeriod;
    training.startRecording(recordingOf(events == 20 ? 7 : 4, start + events / 2 * kPeriod));
    for (const Event& event : recording(start, events)) {
      training.add(event);
    }
  }
  return training.finish();
}

// Trains on recordings of 10, 20 and 40 events.
TrainingCounts threeRecordings(const Training::Parameters& parameters) {
  return countsOf(parameters, {10, 20, 40});
}

std::uint64_t eventsOf(const evidence::Statistics& half) {
  return half.type(0).events + half.type(1).events;
}

TEST(Training, RecordingsBelongToTheTwoHalvesByTheirFingerprint) {
  const TrainingCounts counts = threeRecordings(counting(true, true));
  EXPECT_EQ(eventsOf(counts.halves[0]), 50U);
  EXPECT_EQ(eventsOf(counts.halves[1]), 20U);
  EXPECT_EQ(counts.delays.events(), 70U);
  EXPECT_EQ(counts.only_half, std::nullopt);
}

TEST(Training, TheOrderOfRecordingsDoesNotMatter) {
  const TrainingCounts counts = threeRecordings(counting(true, true));
  for (const std::vector<int>& order : std::vector<std::vector<int>>{
           {10, 40, 20}, {20, 10, 40}, {20, 40, 10}, {40, 10, 20}, {40, 20, 10}}) {
    const TrainingCounts other = countsOf(counting(true, true), order);
    EXPECT_TRUE(other.halves == counts.halves);
    EXPECT_TRUE(other.delays == counts.delays);
  }
}

TEST(Halves, CountsAddUpToThoseOfOneTraining) {
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
    TrainingCounts sum = countsOf(counting(true, false), first);
    const TrainingCounts other = countsOf(counting(true, false), second);
    evidence::merge(sum.halves, sum.only_half, other.halves, other.only_half);
    EXPECT_TRUE(sum.halves == threeRecordings(counting(true, false)).halves) << in_first;
  }
  // Recordings of one half stay in two parts.
  TrainingCounts sum = countsOf(counting(true, false), {10});
  const TrainingCounts other = countsOf(counting(true, false), {40});
  evidence::merge(sum.halves, sum.only_half, other.halves, other.only_half);
  EXPECT_TRUE(sum.halves == countsOf(counting(true, false), {10, 40}).halves);
  EXPECT_EQ(eventsOf(sum.halves[0]), 25U);
}

TEST(Training, CountsWhatItsTrainersDo) {
  const TrainingCounts counts = threeRecordings(counting(true, true));
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
    for (const Event& event : recording(events * 1000 * kPeriod, events)) {
      paper_trainer.add(event);
      if (events != 20) {
        trainer.add(event);
      }
    }
  }
  trainer.finish();
  EXPECT_TRUE(counts.delays == delays);
  EXPECT_TRUE(counts.halves[0] == half);
}

TEST(Training, CountsOnlyForTheDetectorsAskedFor) {
  const TrainingCounts both = threeRecordings(counting(true, true));
  const TrainingCounts evidence = threeRecordings(counting(true, false));
  EXPECT_TRUE(evidence.halves == both.halves);
  EXPECT_EQ(evidence.delays.pairs(), 0U);
  EXPECT_EQ(evidence.delays.eventCount(0), both.delays.eventCount(0));
  const TrainingCounts paper = threeRecordings(counting(false, true));
  EXPECT_TRUE(paper.delays == both.delays);
  EXPECT_EQ(paper.halves[0].size(), 0U);
  EXPECT_THROW(Training(counting(false, false)), std::invalid_argument);
}

TEST(Training, ThePaperKnowsNoModes) {
  for (const bool paper : {true, false}) {
    Training training(counting(true, paper));
    training.intern(kType);
    const EventId mode = training.intern({"/b", "/y", typeOfMode("t", "DRIVING")});
    training.startRecording(recordingOf(1, kPeriod));
    for (const Event& event : recording(0, 100)) {
      training.add(event);
    }
    const TrainingCounts counts = training.finish();
    EXPECT_EQ(counts.delays.eventCount(0), 50U);
    EXPECT_EQ(counts.delays.eventCount(mode), 0U);
    EXPECT_EQ(counts.halves[0].type(mode).events + counts.halves[1].type(mode).events, 5U)
        << "that it ticks in 5 s";
  }
}

TEST(Training, RecordingsOfOneHalfAreCutInTwo) {
  Training training(counting(true, true));
  training.intern(kType);
  training.intern(kOther);
  training.startRecording(recordingOf(3, 6 * kPeriod));
  for (const Event& event : recording(0, 10)) {
    training.add(event);
  }
  const TrainingCounts counts = training.finish();
  EXPECT_EQ(counts.only_half, std::optional<std::size_t>(1));
  EXPECT_EQ(eventsOf(counts.halves[0]), 6U);
  EXPECT_EQ(eventsOf(counts.halves[1]), 4U);
  EXPECT_EQ(counts.halves[1].type(0).gaps, 2U);  // the one over the cut ends in the second part
  EXPECT_EQ(counts.halves[0].recordings().size() + counts.halves[1].recordings().size(), 1U);
  EXPECT_THROW(training.finish(), std::logic_error);
}

TEST(CrossFit, AHalfIsJudgedByWhatTheOtherSays) {
  Training training(counting(true, false));
  training.intern(kType);
  training.intern(kOther);
  for (const int events : {200, 301}) {
    training.startRecording(recordingOf(static_cast<std::uint64_t>(events)));
    for (const Event& event : recording(0, events)) {
      training.add(event);
    }
  }
  const TrainingCounts counts = training.finish();
  const evidence::Watched watched = evidence::watch(counts.halves[0], counts.halves[1]);
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
