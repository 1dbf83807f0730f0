#include "run_node.h"

#include <ros/ros.h>

#include <csignal>
#include <exception>

namespace self_awareness {
namespace {

volatile std::sig_atomic_t running = 0;
volatile std::sig_atomic_t stopping = 0;

// roscpp's own handler would close the connections while the node's threads use them: what was
// made must end first. While the process waits for the master, there is nothing yet.
void onSignal(int /*signal*/) {
  stopping = 1;
  if (running == 0) {
    ros::requestShutdown();
  }
}

void run(const std::function<std::shared_ptr<void>()>& make) {
  running = 1;
  const std::shared_ptr<void> made = make();
  while (ros::ok() && stopping == 0) {
    ros::WallDuration(0.1).sleep();
  }
}

}  // namespace

int runNode(int argc, char** argv, const std::string& name,
            const std::function<std::shared_ptr<void>()>& make) {
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  const ros::NodeHandle node_handle;  // waits for the master, and outlives what is made
  try {
    run(make);
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}

void endNode() {
  stopping = 1;
}

}  // namespace self_awareness
