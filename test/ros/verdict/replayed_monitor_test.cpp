// What a monitor would have said of a recording. test/rostest/flight_recorder_test.py compares it
// with what one did say.

#include <gtest/gtest.h>
#include <rosbag/view.h>

#include <cstdint>
#include <string>
#include <vector>

#include "../../in_folder.h"
#include "../../times.h"
#include "ros/verdict/result_bag.h"
#include "self_awareness/core/paper/judge.h"

namespace self_awareness::ros1 {
namespace {

using self_awareness::SelfAwareness;

constexpr std::int64_t kMillisecond = 1000000;  // [ns]
const core::EventType kScan{"/player", "/scan", "std_msgs/String"};
const core::EventType kPose{"/slam", "/pose", "std_msgs/String"};

/// A scan each 100 ms, and a pose 20 ms later.
core::paper::DelayStatistics trained() {
  core::paper::DelayStatistics statistics{core::paper::Binning{}};
  for (const core::EventType& type : {kScan, kPose}) {
    statistics.countEvent(statistics.intern(type));
  }
  for (int i = 0; i < 100; ++i) {
    for (core::EventId from : {0U, 1U}) {
      statistics.pair(from, from).add(10);
      statistics.pair(from, 1 - from).add(from == 0 ? 2 : 8);
    }
  }
  return statistics;
}

/// The scans fail for two seconds, and again until the clock is set back by a minute; then
/// something comes that the model does not know.
std::vector<core::Event> events() {
  std::vector<core::Event> events;
  for (int i = 0; i < 300; ++i) {
    const std::int64_t stamp = kStart + i * kWindow - (i < 200 ? 0 : 60 * kSecond);
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
    ResultBag bag(path_);
    ReplayedMonitor replayed(bag, {"robot.model", true, kWindow, 2},
                             {kScan, kPose, {"/joy", "/joy", "std_msgs/String"}}, kStart);
    core::Detector::Parameters parameters;
    parameters.settle_time = kSecond;
    core::Detector detector(
        core::paper::makeJudge(std::make_shared<core::paper::Model>(trained()), 1.2, true),
        kWindow, parameters, [&](const core::Verdict& verdict) { replayed.onVerdict(verdict); });
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

  const std::string path_ = path("out.bag");
};

TEST_F(ReplayedMonitorTest, SaysWhatAMonitorWouldHaveSaid) {
  std::vector<std::uint8_t> levels;
  const auto alarms = read<SelfAwareness>("/self_awareness/alarm");
  for (const SelfAwareness& alarm : alarms) {
    levels.push_back(alarm.level);
  }
  const std::vector<std::uint8_t> in_order_of_time{
      SelfAwareness::OK,                                             // the clock was set
      SelfAwareness::WARN, SelfAwareness::OK,                        // the unknown event
      SelfAwareness::WARN, SelfAwareness::ERROR, SelfAwareness::OK,  // no scans
      SelfAwareness::WARN, SelfAwareness::ERROR};                    // again
  EXPECT_EQ(levels, in_order_of_time);
  EXPECT_EQ(alarms.at(0).message, kClockWasSet);
  EXPECT_EQ(alarms.at(4).component, "/player");
  EXPECT_GT(read<SelfAwareness>("/self_awareness/status").size(), 280U);
}

TEST_F(ReplayedMonitorTest, TheDiagnosticsGoOnWhileTheClockIsSet) {
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
  EXPECT_TRUE(ResultBag::isOne(path_));
  const std::string recording = path("recording.bag");
  {
    rosbag::Bag bag(recording, rosbag::bagmode::Write);
    bag.write("/self_awareness/status", ros::TIME_MIN, SelfAwareness());
  }
  EXPECT_FALSE(ResultBag::isOne(recording)) << "it has the same topic";
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Append);
    bag.write("/scan", ros::TIME_MIN, SelfAwareness());
  }
  EXPECT_FALSE(ResultBag::isOne(path_)) << "somebody has added to it";
  EXPECT_FALSE(ResultBag::isOne(path("missing.bag")));
}

}  // namespace
}  // namespace self_awareness::ros1
