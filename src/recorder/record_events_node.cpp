#include <ros/node_handle.h>

#include "event_recorder.h"
#include "node/run_node.h"

constexpr char kUsage[] =
    "usage: rosrun self_awareness record_events _output:=PREFIX [_PARAMETER:=VALUE...]\n\n"
    "Records event logs of the running robot. Better: roslaunch self_awareness record.launch\n"
    "output:=PREFIX; with --ros-args, it explains its arguments.";

int main(int argc, char** argv) {
  return self_awareness::runNode(argc, argv, "recorder", kUsage, [] {
    return std::make_unique<self_awareness::EventRecorder>(ros::NodeHandle(), ros::NodeHandle("~"),
                                                           self_awareness::endNode);
  });
}
