#include "self_awareness/core/verdict/detector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/paper/delay_trainer.h"
#include "self_awareness/core/paper/judge.h"
#include "self_awareness/core/stream/clock.h"
#include "self_awareness/core/verdict/persistence.h"

namespace self_awareness::core {
namespace {

constexpr std::int64_t kMillisecond = 1000000;
constexpr std::int64_t kSecond = 1000 * kMillisecond;
const EventType kLaser{"/player", "/scan", "sensor_msgs/LaserScan"};
const EventType kPose{"/slam", "/pose", "geometry_msgs/PoseStamped"};
const EventType kWheels{"/base", "/odom", "nav_msgs/Odometry"};

// A robot with exact timing: a scan every 80 ms, its pose 10 ms later, odometry every 20 ms.
std::vector<Event> clockwork(std::int64_t start, std::int64_t end, bool laser) {
  std::vector<Event> events;
  for (std::int64_t t = start; t < end; t += 10 * kMillisecond) {
    const std::int64_t phase = (t - start) / kMillisecond;
    if (laser && phase % 80 == 0) {
      events.push_back({t, 0});
    }
    if (laser && phase % 80 == 10) {
      events.push_back({t, 1});
    }
    if (phase % 20 == 0) {
      events.push_back({t + kMillisecond, 2});
    }
  }
  return events;
}

std::shared_ptr<const paper::Model> trainedModel() {
  paper::DelayStatistics statistics(paper::Binning{10 * kMillisecond, 0});
  for (const EventType& type : {kLaser, kPose, kWheels}) {
    statistics.intern(type);
  }
  paper::DelayTrainer trainer(statistics);
  for (const Event& event : clockwork(0, 60 * kSecond, true)) {
    trainer.add(event);
  }
  return std::make_shared<const paper::Model>(statistics);
}

struct Seen : Verdict {
  std::int64_t start = 0;  // of the window [ns]
};

class DetectorTest : public testing::Test {
 protected:
  Detector makeDetector(std::optional<double> threshold,
                        const Detector::Parameters& parameters = {}) {
    return Detector(paper::makeJudge(model_, threshold, parameters.silence_is_abnormal),
                    100 * kMillisecond, parameters, [this](const Verdict& verdict) {
                      seen_.push_back({verdict, verdict.window->start});
                    });
  }
  static void feed(Detector& detector, const std::vector<Event>& events) {
    for (const Event& event : events) {
      detector.add(event);
    }
  }
  // End of the first window that raised the alarm.
  std::optional<std::int64_t> firstAlarm() const {
    for (const Seen& seen : seen_) {
      if (seen.changed && seen.alarm) {
        return seen.start + 100 * kMillisecond;
      }
    }
    return std::nullopt;
  }

  std::shared_ptr<const paper::Model> model_ = trainedModel();
  std::vector<Seen> seen_;
};

TEST_F(DetectorTest, NormalOperationIsNeverAbnormalOnceSettled) {
  Detector detector = makeDetector(0.5);
  feed(detector, clockwork(1000 * kSecond, 1030 * kSecond, true));
  detector.finish();
  ASSERT_EQ(seen_.size(), 300U);
  for (const Seen& seen : seen_) {
    EXPECT_FALSE(seen.abnormal && !seen.settling) << seen.start;
    EXPECT_EQ(seen.settling, seen.start < 1005 * kSecond) << seen.start;
  }
}

TEST_F(DetectorTest, NamesTheComponentThatFellSilent) {
  Detector detector = makeDetector(1.5);
  feed(detector, clockwork(1000 * kSecond, 1010 * kSecond, true));
  feed(detector, clockwork(1010 * kSecond, 1015 * kSecond, false));
  const auto alarm = firstAlarm();
  ASSERT_TRUE(alarm.has_value());
  EXPECT_GT(*alarm, 1010 * kSecond);
  EXPECT_LE(*alarm, 1011 * kSecond);
  ASSERT_FALSE(seen_.back().suspects.empty());
  const Suspect& first = seen_.back().suspects.front();
  EXPECT_EQ(model_->vocabulary().at(first.id), kLaser);
  EXPECT_EQ(first.reason.kind, Kind::kSilent);
  EXPECT_NEAR(first.reason.value, 5.0, 0.3);
  EXPECT_NE(first.reason.words.find("silent for 4."), std::string::npos) << first.reason.words;
  EXPECT_NE(first.reason.words.find("usually every 0.080 to 0.090 s"), std::string::npos)
      << first.reason.words;
}

TEST_F(DetectorTest, TotalSilenceIsAbnormalByTimeAlone) {
  Detector detector = makeDetector(0.5);
  feed(detector, clockwork(1000 * kSecond, 1010 * kSecond, true));
  detector.advance(1011 * kSecond);
  const auto alarm = firstAlarm();
  ASSERT_TRUE(alarm.has_value());
  EXPECT_EQ(*alarm, 1010300 * kMillisecond);  // the third window without an event
  EXPECT_EQ(seen_.size(), 110U);
  seen_.clear();
  Detector::Parameters parameters;
  parameters.silence_is_abnormal = false;
  Detector deaf = makeDetector(0.5, parameters);
  feed(deaf, clockwork(1000 * kSecond, 1010 * kSecond, true));
  deaf.advance(1020 * kSecond);
  EXPECT_FALSE(firstAlarm().has_value()) << "it may be ignored";
}

TEST_F(DetectorTest, AStepOfTheClockStartsANewRecordingWithoutAnAlarm) {
  for (const std::int64_t step : {-500 * kSecond, kLongestSilence + kSecond}) {
    seen_.clear();
    Detector detector = makeDetector(0.5);
    feed(detector, clockwork(1000 * kSecond, 1010 * kSecond, true));
    const std::vector<Event> after = clockwork(1010 * kSecond + step, 1020 * kSecond + step, true);
    EXPECT_FALSE(detector.add(after.front()));
    feed(detector, {after.begin() + 1, after.end()});
    detector.finish();
    EXPECT_FALSE(firstAlarm().has_value()) << step;
    EXPECT_LT(seen_.size(), 205U) << step;  // no windows for the time that the step skipped
    EXPECT_TRUE(seen_[120].settling) << step;
  }
}

TEST_F(DetectorTest, AResumedAlarmStandsUntilItsSuspectIsHeardForLongEnough) {
  Suspect laser;
  laser.component = kLaser.source;
  laser.since = 7;
  Detector detector = makeDetector(0.01);
  detector.resume({laser});
  feed(detector, clockwork(0, 20 * kSecond, false));
  const auto changes = [&] {
    return std::count_if(seen_.begin(), seen_.end(), [](const Seen& s) { return s.changed; });
  };
  EXPECT_TRUE(std::all_of(seen_.begin(), seen_.end(), [](const Seen& s) { return s.alarm; }));
  EXPECT_EQ(changes(), 0);
  feed(detector, clockwork(20 * kSecond, 40 * kSecond, true));
  detector.finish();
  EXPECT_EQ(changes(), 1);
  const auto over =
      std::find_if(seen_.begin(), seen_.end(), [](const Seen& s) { return !s.alarm; });
  ASSERT_NE(over, seen_.end());
  // It settles for 5 s, and the hold time is 2 s.
  EXPECT_GE(over->start, 26800 * kMillisecond);
  EXPECT_LE(over->start, 28 * kSecond);
}

TEST_F(DetectorTest, AResumedAlarmWhoseSuspectsCameAllTheTimeStandsWhileAllSettle) {
  Suspect fast;
  fast.id = 1;
  fast.reason.kind = Kind::kFast;
  for (const bool cleared : {false, true}) {
    seen_.clear();
    Detector detector = makeDetector(0.01);
    detector.resume({fast});
    if (cleared) {
      detector.clearAlarm();
    }
    feed(detector, clockwork(0, 20 * kSecond, true));
    EXPECT_EQ(seen_.front().alarm, !cleared);
    EXPECT_FALSE(seen_.back().alarm);
    const auto over =
        std::find_if(seen_.begin(), seen_.end(), [](const Seen& s) { return !s.alarm; });
    EXPECT_GE(over->start, cleared ? 0 : 6900 * kMillisecond);
    EXPECT_LE(over->start, cleared ? 0 : 8 * kSecond);
  }
}

TEST_F(DetectorTest, AComponentThatWasHeardMayBeHeardOnANewTopic) {
  paper::DelayStatistics statistics(paper::Binning{10 * kMillisecond, 0});
  statistics.intern({"/a", "/often", "T"});
  statistics.intern({"/a", "/rarely", "T"});
  paper::DelayTrainer trainer(statistics);
  for (std::int64_t i = 0; i < 500; ++i) {
    trainer.add({i * 20 * kMillisecond, i % 50 == 0 ? 1U : 0U});
  }
  model_ = std::make_shared<const paper::Model>(statistics);
  Detector detector = makeDetector(0.01);
  for (std::int64_t i = 0; i < 500; ++i) {
    detector.add({i * 20 * kMillisecond, 0});
  }
  detector.add({10 * kSecond, 1});
  detector.advance(11 * kSecond);
  EXPECT_FALSE(seen_.back().settling);
}

TEST_F(DetectorTest, RefusesAThresholdThatIsNoNumber) {
  EXPECT_THROW(makeDetector(std::nan("")), std::invalid_argument);
  EXPECT_THROW(makeDetector(std::numeric_limits<double>::infinity()), std::invalid_argument);
}

TEST(Persistence, RaisesAtKOfNAndClearsAfterTheHoldTime) {
  Persistence persistence({3, 5, 200});
  std::int64_t end = 0;
  const auto add = [&](bool abnormal) { return persistence.add(abnormal, end += 100); };
  for (const bool abnormal : {true, false, true, false, false}) {
    EXPECT_FALSE(add(abnormal));
  }
  EXPECT_FALSE(add(true));  // 2 of the last 5
  EXPECT_FALSE(add(false));
  EXPECT_FALSE(add(true));
  EXPECT_TRUE(add(true));  // 3 of 5
  EXPECT_TRUE(add(false));
  EXPECT_FALSE(add(false));
}

TEST(Persistence, RefusesImpossibleValues) {
  EXPECT_THROW(Persistence({0, 5, 0}), std::invalid_argument);
  EXPECT_THROW(Persistence({6, 5, 0}), std::invalid_argument);
  EXPECT_THROW(Persistence({1, 5, -1}), std::invalid_argument);
}

}  // namespace
}  // namespace self_awareness::core
