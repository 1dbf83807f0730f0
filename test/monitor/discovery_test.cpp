// Needs a master: this process publishes, and discovers itself.

#include "monitor/discovery.h"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/String.h>

#include <functional>

namespace self_awareness {
namespace {

bool await(const std::function<bool()>& condition) {
  const ros::SteadyTime deadline = ros::SteadyTime::now() + ros::WallDuration(20);
  while (!condition()) {
    if (ros::SteadyTime::now() > deadline) {
      return false;
    }
    ros::WallDuration(0.01).sleep();
  }
  return true;
}

class DiscoveryTest : public testing::Test {
 protected:
  DiscoveryTest() {
    node_handle_.setCallbackQueue(&never_served_);
    wanted_.model_topics = {"/a", "/b"};
    wanted_.encoder = std::make_shared<ros1::Encoder>(
        ros1::EncodingRules(), [](const core::EventType& /*type*/) { return 0; });
  }
  /// @param interval [s]; by default, so long that nothing is polled unless asked for
  std::unique_ptr<Discovery> discover(double interval = 3600) {
    return std::make_unique<Discovery>(node_handle_, arrivals_, ros1::SubscribePolicy::kModel,
                                       interval, std::vector<std::string>());
  }
  ros::Publisher publish(const std::string& topic) {
    return node_handle_.advertise<std_msgs::String>(topic, 1);
  }
  static bool knows(const Discovery& discovery, const std::string& topic) {
    const std::shared_ptr<const ros1::Graph> graph = discovery.state().graph;
    return graph && graph->topics.count(topic) > 0 &&
           graph->topics.at(topic).publishers.count(ros::this_node::getName()) > 0;
  }

  ros::NodeHandle node_handle_;
  ros::CallbackQueue never_served_;
  ros1::Arrivals arrivals_{1, [] {}};
  Discovery::Wanted wanted_;
};

TEST_F(DiscoveryTest, KeepsTheNewestGraph) {
  const auto discovery = discover(0.05);
  const ros::Publisher first = publish("/a");
  EXPECT_TRUE(await([&] { return knows(*discovery, "/a"); }));
  ros::Publisher second = publish("/b");
  EXPECT_TRUE(await([&] { return knows(*discovery, "/b"); }));
  second.shutdown();
  EXPECT_TRUE(await([&] { return !knows(*discovery, "/b"); }));
  EXPECT_TRUE(knows(*discovery, "/a"));
}

TEST_F(DiscoveryTest, PollsAtOnceWhenItIsAsked) {
  const auto discovery = discover();
  discovery->setWanted(wanted_);
  ASSERT_TRUE(await([&] { return discovery->state().subscriptions == 2; }));
  const ros::Publisher publisher = publish("/b");
  EXPECT_TRUE(await([&] {
    discovery->pollNow();
    return knows(*discovery, "/b");
  }));
}

}  // namespace
}  // namespace self_awareness

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "discovery_test");
  ros::start();
  return RUN_ALL_TESTS();
}
