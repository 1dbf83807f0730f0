#include "self_awareness/core/training.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "core/paper/delay_trainer.h"
#include "self_awareness/core/evidence/cross_fit.h"
#include "self_awareness/core/evidence/tracks.h"

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

// Trains on recordings of 10, 20 and 40 events.
TrainingCounts threeRecordings(const Training::Parameters& parameters) {
  Training training(parameters);
  training.intern(kType);
  training.intern(kOther);
  for (const int events : {10, 20, 40}) {
    training.startRecording();
    for (const Event& event : recording(events * 1000 * kPeriod, events)) {
      training.add(event);
    }
  }
  return training.finish();
}

std::uint64_t eventsOf(const evidence::Statistics& half) {
  return half.type(0).events + half.type(1).events;
}

TEST(Training, RecordingsBelongToTheTwoHalvesInTurn) {
  const TrainingCounts counts = threeRecordings(counting(true, true));
  EXPECT_EQ(eventsOf(counts.halves[0]), 50U);
  EXPECT_EQ(eventsOf(counts.halves[1]), 20U);
  EXPECT_EQ(counts.delays.events(), 70U);
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

TEST(Training, TheOnlyRecordingIsCutInTwo) {
  Training training(counting(true, true));
  training.intern(kType);
  training.intern(kOther);
  training.startOnlyRecording(6 * kPeriod);
  for (const Event& event : recording(0, 10)) {
    training.add(event);
  }
  EXPECT_THROW(training.startOnlyRecording(0), std::logic_error);
  const TrainingCounts counts = training.finish();
  EXPECT_EQ(eventsOf(counts.halves[0]), 6U);
  EXPECT_EQ(eventsOf(counts.halves[1]), 4U);
  EXPECT_EQ(counts.halves[1].type(0).gaps, 1U);  // no gap crosses the cut
  EXPECT_THROW(training.finish(), std::logic_error);
}

TEST(CrossFit, AHalfIsJudgedByWhatTheOtherSays) {
  Training training(counting(true, false));
  training.intern(kType);
  training.intern(kOther);
  for (const int events : {200, 300}) {
    training.startRecording();
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
