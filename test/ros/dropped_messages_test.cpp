// Needs a master: asks roscpp what it dropped.

#include "self_awareness/ros/dropped_messages.h"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/String.h>

namespace self_awareness::ros1 {
namespace {

TEST(DroppedMessages, CountsWhatDidNotFitIntoTheQueue) {
  ros::NodeHandle node_handle;
  ros::CallbackQueue never_served;
  node_handle.setCallbackQueue(&never_served);
  DroppedMessages dropped;
  EXPECT_EQ(dropped.count(), 0U);
  {
    const boost::function<void(const std_msgs::String::ConstPtr&)> ignore =
        [](const std_msgs::String::ConstPtr& /*message*/) {};
    const ros::Subscriber subscriber = node_handle.subscribe<std_msgs::String>("/a", 3, ignore);
    ros::Publisher publisher = node_handle.advertise<std_msgs::String>("/a", 100);
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(20);
    while (subscriber.getNumPublishers() == 0 && ros::WallTime::now() < deadline) {
      ros::WallDuration(0.01).sleep();
    }
    for (int i = 0; i < 10; ++i) {
      publisher.publish(std_msgs::String());
    }
    EXPECT_EQ(dropped.count(), 7U);
  }
  EXPECT_EQ(dropped.count(), 7U);  // the connection is gone, what it lost stays lost
}

}  // namespace
}  // namespace self_awareness::ros1

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "dropped_messages_test");
  ros::start();
  return RUN_ALL_TESTS();
}
