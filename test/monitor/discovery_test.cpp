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

TEST_F(DiscoveryTest, TellsOfAPublisherThatRegistersLaterOnce) {
  const ros::Publisher first = publish("/a");
  const auto discovery = discover();
  discovery->setWanted(wanted_);
  ASSERT_TRUE(await([&] { return discovery->state().subscriptions == 2; }));
  EXPECT_TRUE(discovery->takeNewPublishers().empty());

  const auto knows_b = [&] {
    discovery->pollNow();
    return knows(*discovery, "/b");
  };
  ros::Publisher second = publish("/b");
  ASSERT_TRUE(await(knows_b));
  const std::vector<ros1::Publisher> found = discovery->takeNewPublishers();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].source, ros::this_node::getName());
  EXPECT_EQ(found[0].topic, "/b");

  second.shutdown();
  ASSERT_TRUE(await([&] { return !knows_b(); }));
  second = publish("/b");
  ASSERT_TRUE(await(knows_b));
  EXPECT_TRUE(discovery->takeNewPublishers().empty());
}

TEST_F(DiscoveryTest, PublishersThatItFindsAfterARestartAreNotNew) {
  const auto discovery = discover();
  discovery->setWanted(wanted_);
  ASSERT_TRUE(await([&] { return discovery->state().subscriptions == 2; }));
  ros::Publisher publisher = publish("/b");
  discovery->restart();
  ASSERT_TRUE(await([&] { return knows(*discovery, "/b"); }));
  EXPECT_TRUE(discovery->takeNewPublishers().empty());
}

TEST_F(DiscoveryTest, LeavesOutTheMonitorsOwnOutput) {
  wanted_.own_output = ros1::OwnOutput(ros::this_node::getName(), {"/a"});
  const auto discovery = discover(0.05);
  discovery->setWanted(wanted_);
  ASSERT_TRUE(await([&] { return discovery->state().subscriptions == 2; }));
  const ros::Publisher own = publish("/b");
  ASSERT_TRUE(await([&] { return knows(*discovery, "/b"); }));
  EXPECT_TRUE(discovery->takeNewPublishers().empty());
  const ros::Publisher of_the_robot = publish("/a");
  ASSERT_TRUE(await([&] { return knows(*discovery, "/a"); }));
  EXPECT_EQ(discovery->takeNewPublishers().size(), 1U);
}

}  // namespace
}  // namespace self_awareness

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "discovery_test");
  ros::start();
  return RUN_ALL_TESTS();
}
