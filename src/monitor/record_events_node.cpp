#include <ros/node_handle.h>

#include "event_recorder.h"
#include "run_node.h"

int main(int argc, char** argv) {
  return self_awareness::runNode(argc, argv, "recorder", [] {
    return std::make_unique<self_awareness::EventRecorder>(ros::NodeHandle(), ros::NodeHandle("~"),
                                                           self_awareness::endNode);
  });
}
