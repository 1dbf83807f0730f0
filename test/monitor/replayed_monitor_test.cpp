// A recording that is judged afterwards says what a monitor's session said while it was made.

#include <gtest/gtest.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "../in_folder.h"
#include "../ros/serialized.h"
#include "../times.h"
#include "monitor/session.h"
#include "ros/verdict/result_bag.h"
#include "self_awareness/core/paper/judge.h"

namespace self_awareness {
namespace {

using self_awareness::SelfAwareness;

constexpr std::int64_t kMillisecond = 1000000;  // [ns]
const std::vector<core::EventType> kTypes = {{"/player", "/scan", "std_msgs/String"},
                                             {"/slam", "/pose", "std_msgs/String"}};

ros1::TrainedModel trained() {
  ros1::TrainedModel model;
  for (const core::EventType& type : kTypes) {
    model.statistics.countEvent(model.statistics.intern(type));
  }
  for (int i = 0; i < 100; ++i) {
    for (core::EventId from : {0U, 1U}) {
      model.statistics.pair(from, from).add(10);
      model.statistics.pair(from, 1 - from).add(from == 0 ? 2 : 8);
    }
  }
  model.paper_calibration = core::paper::Calibration();
  model.paper_calibration->threshold = 1.2;
  return model;
}

/// A scan each 100 ms, and a pose 20 ms later. The scans fail for two seconds, and again when the
/// clock is set back by a minute; then something comes that the model does not know.
std::vector<core::Event> events() {
  std::vector<core::Event> events;
  for (int i = 0; i < 300; ++i) {
    const std::int64_t stamp =
        kStart + i * kWindow - (i < 200 ? 0 : 60 * core::kNanosecondsPerSecond);
    if (i < 100 || (i >= 120 && i < 190) || i >= 200) {
      events.push_back({stamp, 0});
    }
    events.push_back({stamp + 20 * kMillisecond, 1});
    if (i == 250) {
      events.push_back({stamp + 50 * kMillisecond, 2});
    }
  }
  return events;
}

class ReplayedMonitorTest : public InFolder {
 protected:
  ReplayedMonitorTest() {
    parameters_.method = MonitorParameters::Method::kPaper;
    parameters_.detector.settle_time = core::kNanosecondsPerSecond;
    vocabulary_.push_back({"/joy", "/joy", "std_msgs/String"});
  }

  /// What the monitor publishes of the events while they happen.
  void monitor() {
    ros1::AlarmState alarm({[&](const SelfAwareness& status) { statuses_.push_back(status); },
                            [&](const SelfAwareness& alarm) { alarms_.push_back(alarm); }, [] {}});
    const core::Vocabulary vocabulary(vocabulary_);
    Session session(trained(), parameters_, [&](const core::Verdict& verdict) {
      alarm.add(verdict, vocabulary, session.window());
    });
    for (const core::Event& event : events()) {
      if (!session.detector().add(event)) {
        alarm.standDown(ros1::kClockWasSet, event.stamp);
      }
    }
    session.detector().finish();
  }

  /// What is said of them afterwards.
  void replay() {
    ros1::ResultBag bag(path_);
    const ros1::TrainedModel model = trained();
    ros1::ReplayedMonitor replayed(bag, {"robot.model", true, model.window, kTypes.size()},
                                   vocabulary_, kStart);
    core::Detector detector(
        core::paper::makeJudge(std::make_shared<core::paper::Model>(model.statistics),
                               model.threshold(), true),
        model.window, parameters_.detector,
        [&](const core::Verdict& verdict) { replayed.onVerdict(verdict); });
    for (const core::Event& event : events()) {
      const bool same_clock = detector.add(event);
      replayed.onEvent(event, same_clock);
    }
    detector.finish();
    bag.close();
  }

  template <typename Message>
  std::vector<Message> read(const std::string& topic) const {
    const rosbag::Bag bag(path_, rosbag::bagmode::Read);
    rosbag::View view(bag, rosbag::TopicQuery(topic));
    std::vector<Message> messages;
    for (const rosbag::MessageInstance& instance : view) {
      messages.push_back(*instance.instantiate<Message>());
      EXPECT_EQ(instance.getTime(), messages.back().header.stamp);
      EXPECT_EQ(instance.getCallerId(), "/self_awareness");
    }
    return messages;
  }

  /// In the order of a bag that is read: the clock was set back.
  static std::vector<std::vector<std::uint8_t>> inOrderOfTime(
      std::vector<SelfAwareness> messages) {
    std::stable_sort(messages.begin(), messages.end(),
                     [](const auto& a, const auto& b) { return a.header.stamp < b.header.stamp; });
    return serialized(messages);
  }
  static std::vector<std::vector<std::uint8_t>> serialized(
      const std::vector<SelfAwareness>& messages) {
    std::vector<std::vector<std::uint8_t>> all;
    all.reserve(messages.size());
    for (const SelfAwareness& message : messages) {
      all.push_back(ros1::serialized(message));
    }
    return all;
  }

  const std::string path_ = path("out.bag");
  MonitorParameters parameters_;
  std::vector<core::EventType> vocabulary_ = kTypes;
  std::vector<SelfAwareness> statuses_;
  std::vector<SelfAwareness> alarms_;
};

TEST_F(ReplayedMonitorTest, SaysWhatTheMonitorSays) {
  monitor();
  replay();
  ASSERT_GT(statuses_.size(), 280U);
  const std::vector<std::uint8_t> expected = {
      SelfAwareness::WARN, SelfAwareness::ERROR, SelfAwareness::OK,  // no scans
      SelfAwareness::WARN, SelfAwareness::ERROR, SelfAwareness::OK,  // no scans; the clock is set
      SelfAwareness::WARN, SelfAwareness::OK};                       // the unknown event
  std::vector<std::uint8_t> levels;
  for (const SelfAwareness& alarm : alarms_) {
    levels.push_back(alarm.level);
  }
  ASSERT_EQ(levels, expected);
  EXPECT_EQ(serialized(read<SelfAwareness>("/self_awareness/status")), inOrderOfTime(statuses_));
  EXPECT_EQ(serialized(read<SelfAwareness>("/self_awareness/alarm")), inOrderOfTime(alarms_));
}

TEST_F(ReplayedMonitorTest, TheDiagnosticsGoOnWhileTheClockIsSet) {
  replay();
  const auto diagnostics = read<diagnostic_msgs::DiagnosticArray>("/diagnostics");
  ASSERT_GE(diagnostics.size(), 30U) << "30 s";
  for (const diagnostic_msgs::DiagnosticArray& array : diagnostics) {
    ASSERT_EQ(array.status.size(), 3U);
    EXPECT_EQ(array.status[0].name, "self_awareness: communication");
    EXPECT_EQ(array.status[1].name, "self_awareness: /player");
    EXPECT_EQ(array.status[2].name, "self_awareness: /slam");
    for (const auto& pair : array.status[2].values) {
      if (pair.key == "events a second") {
        EXPECT_NEAR(std::stod(pair.value), 10, 5) << array.header.stamp;
      }
    }
  }
}

TEST_F(ReplayedMonitorTest, AResultBagIsNotMistakenForARecording) {
  replay();
  EXPECT_TRUE(ros1::ResultBag::isOne(path_));
  const std::string recording = path("recording.bag");
  {
    rosbag::Bag bag(recording, rosbag::bagmode::Write);
    bag.write("/self_awareness/status", ros::TIME_MIN, SelfAwareness());
  }
  EXPECT_FALSE(ros1::ResultBag::isOne(recording)) << "it has the same topic";
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Append);
    bag.write("/scan", ros::TIME_MIN, SelfAwareness());
  }
  EXPECT_FALSE(ros1::ResultBag::isOne(path_)) << "somebody has added to it";
  EXPECT_FALSE(ros1::ResultBag::isOne(path("missing.bag")));
}

}  // namespace
}  // namespace self_awareness
