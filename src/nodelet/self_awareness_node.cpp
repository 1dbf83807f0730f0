#include <ros/ros.h>

#include <exception>

#include "monitor.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "self_awareness");
  const ros::NodeHandle node_handle;
  const ros::NodeHandle private_node_handle("~");
  try {
    const self_awareness::Monitor monitor(node_handle, private_node_handle,
                                          ros::this_node::getName());
    ros::waitForShutdown();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}
