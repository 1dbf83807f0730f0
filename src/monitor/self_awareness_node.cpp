#include <ros/ros.h>

#include <csignal>
#include <exception>

#include "monitor.h"

namespace {

volatile std::sig_atomic_t monitoring = 0;
volatile std::sig_atomic_t stopping = 0;

// roscpp's own handler would close the connections while the monitor's threads use them: the
// monitor must end first. While the process waits for the master, there is no monitor.
void onSignal(int /*signal*/) {
  stopping = 1;
  if (monitoring == 0) {
    ros::requestShutdown();
  }
}

void run() {
  monitoring = 1;
  const self_awareness::Monitor monitor(ros::NodeHandle(), ros::NodeHandle("~"),
                                        ros::this_node::getName());
  while (ros::ok() && stopping == 0) {
    ros::WallDuration(0.1).sleep();
  }
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "self_awareness", ros::init_options::NoSigintHandler);
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  const ros::NodeHandle node_handle;  // waits for the master, and outlives the monitor
  try {
    run();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}
