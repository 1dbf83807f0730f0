#include <ros/node_handle.h>
#include <ros/this_node.h>

#include "monitor.h"
#include "node/run_node.h"

constexpr char kUsage[] =
    "usage: rosrun self_awareness self_awareness_node _model:=FILE [_PARAMETER:=VALUE...]\n\n"
    "The monitor, as a node. Better: roslaunch self_awareness monitor.launch model:=FILE\n"
    "config/self_awareness.yaml explains each parameter, docs/monitor.md what it publishes.";

int main(int argc, char** argv) {
  return self_awareness::runNode(argc, argv, "self_awareness", kUsage, [] {
    return std::make_unique<self_awareness::Monitor>(ros::NodeHandle(), ros::NodeHandle("~"),
                                                     ros::this_node::getName());
  });
}
