#include "ros/nothing_heard.h"

#include <gtest/gtest.h>

namespace self_awareness::ros1 {
namespace {

class NothingHeardTest : public testing::Test {
 protected:
  static EncodingRules defaults() {
    EncodingRules rules;
    rules.exclude_sources = {"/play"};
    return rules;
  }

  Graph graph_;
  const Encoder encoder_{defaults(), [](const core::EventType&) { return core::EventId{0}; }};
};

TEST_F(NothingHeardTest, ARobotThatIsOff) {
  graph_.topics["/rosout"] = {"rosgraph_msgs/Log", {"/rosout_agg"}, {}};
  graph_.topics["/monitor/status"] = {"self_awareness/SelfAwareness", {"/monitor"}, {}};
  graph_.topics["/diagnostics"] = {"diagnostic_msgs/DiagnosticArray", {"/monitor"}, {}};
  EXPECT_EQ(whyNothingIsHeard(graph_, encoder_, false), "no node of a robot publishes anything");
}

TEST_F(NothingHeardTest, APlayerIsNamedWithTheWayOut) {
  graph_.topics["/scan"] = {"sensor_msgs/LaserScan", {"/play_1764000000000000000"}, {"/slam"}};
  graph_.topics["/odom"] = {"nav_msgs/Odometry", {"/play_1764000000000000000"}, {"/slam"}};
  EXPECT_EQ(whyNothingIsHeard(graph_, encoder_, false),
            "/play_1764000000000000000 plays 2 topics; players are left out: use `score BAG` or "
            "`train BAG`, or `source: none` in the encoding");
}

TEST_F(NothingHeardTest, APublisherThatIsNotHeard) {
  graph_.topics["/scan"] = {"sensor_msgs/LaserScan", {"/lidar"}, {}};
  EXPECT_EQ(whyNothingIsHeard(graph_, encoder_, false), "nothing is sent on /scan");
  EXPECT_EQ(whyNothingIsHeard(graph_, encoder_, true),
            "no node of the robot subscribes to /scan; launch it with subscribe:=all to listen "
            "all the same");
}

}  // namespace
}  // namespace self_awareness::ros1
