// The live monitor is compared with this program. It subscribes by ShapeShifter to the topics on
// the command line, as programs do that take messages of every type, and only counts. Prints the
// number when it is interrupted.

#include <ros/ros.h>
#include <topic_tools/shape_shifter.h>

#include <cstdint>
#include <iostream>
#include <vector>

int main(int argc, char** argv) {
  ros::init(argc, argv, "bare_subscriber");
  ros::NodeHandle node_handle;
  constexpr std::uint32_t kQueueSize = 1000;  // the monitor's default
  std::uint64_t counted = 0;
  std::vector<ros::Subscriber> subscribers;
  for (int i = 1; i < argc; ++i) {
    const boost::function<void(const topic_tools::ShapeShifter::ConstPtr&)> count =
        [&counted](const topic_tools::ShapeShifter::ConstPtr& /*message*/) { ++counted; };
    subscribers.push_back(node_handle.subscribe<topic_tools::ShapeShifter>(
        argv[i], kQueueSize, count, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  }
  ros::spin();
  std::cout << counted << std::endl;
  return 0;
}
