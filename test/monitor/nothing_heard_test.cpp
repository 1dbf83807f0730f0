#include "monitor/nothing_heard.h"

#include <gtest/gtest.h>

namespace self_awareness {
namespace {

class NothingHeardTest : public testing::Test {
 protected:
  static ros1::EncodingRules defaults() {
    ros1::EncodingRules rules;
    rules.exclude_sources = {"/play"};
    return rules;
  }

  ros1::Graph graph_;
  const ros1::Encoder encoder_{defaults(),
                               [](const core::EventType&) { return core::EventId{0}; }};
};

TEST_F(NothingHeardTest, WithoutAGraphNobodyKnows) {
  EXPECT_EQ(whyNothingIsHeard(nullptr, encoder_), "the master has not said who publishes");
}

TEST_F(NothingHeardTest, ARobotThatIsOff) {
  graph_.topics["/rosout"] = {"rosgraph_msgs/Log", {"/rosout_agg"}, {}};
  graph_.topics["/monitor/status"] = {"self_awareness/SelfAwareness", {"/monitor"}, {}};
  graph_.topics["/diagnostics"] = {"diagnostic_msgs/DiagnosticArray", {"/monitor"}, {}};
  EXPECT_EQ(whyNothingIsHeard(&graph_, encoder_), "nobody publishes: is the robot started?");
}

TEST_F(NothingHeardTest, APlayerIsNamedWithTheWayOut) {
  graph_.topics["/scan"] = {"sensor_msgs/LaserScan", {"/play_1764000000000000000"}, {"/slam"}};
  graph_.topics["/odom"] = {"nav_msgs/Odometry", {"/play_1764000000000000000"}, {"/slam"}};
  EXPECT_EQ(whyNothingIsHeard(&graph_, encoder_),
            "/play_1764000000000000000 plays 2 topics; players are left out: use `score BAG`, or "
            "a model with `source: none`");
}

TEST_F(NothingHeardTest, APublisherThatIsNotHeard) {
  graph_.topics["/scan"] = {"sensor_msgs/LaserScan", {"/lidar"}, {}};
  EXPECT_EQ(whyNothingIsHeard(&graph_, encoder_),
            "nothing comes on what is listened to, of 1 node that publishes");
}

}  // namespace
}  // namespace self_awareness
