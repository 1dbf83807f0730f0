#include <ros/node_handle.h>
#include <ros/this_node.h>

#include "monitor.h"
#include "run_node.h"

int main(int argc, char** argv) {
  return self_awareness::runNode(argc, argv, "self_awareness", [] {
    return std::make_unique<self_awareness::Monitor>(ros::NodeHandle(), ros::NodeHandle("~"),
                                                     ros::this_node::getName());
  });
}
