#include "self_awareness/ros/live/own_output.h"

#include "self_awareness/ros/stable_name.h"

namespace self_awareness::ros1 {

bool OwnOutput::setGraph(const Graph& graph) {
  Siblings siblings;
  for (const auto& [name, topic] : graph.topics) {
    for (const std::string& publisher : topic.publishers) {
      siblings.add(publisher, topic.datatype);
    }
  }
  const bool changed = siblings != siblings_;
  siblings_ = std::move(siblings);
  return changed;
}

bool OwnOutput::covers(const std::string& node, const std::string& topic) const {
  const bool known = known_.count({stableName(node), topic}) > 0;
  if (node == node_) {
    return topic == "/rosout" || topic == "/diagnostics" || !known;
  }
  // What the model knows goes on to be judged: a node is not left out because it claims to be one
  // of ours.
  return !known && siblings_.cover(node, topic);
}

}  // namespace self_awareness::ros1
