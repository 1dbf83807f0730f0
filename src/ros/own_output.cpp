#include "self_awareness/ros/own_output.h"

#include "self_awareness/ros/graph.h"

namespace self_awareness::ros1 {

bool isOwnType(const std::string& datatype) {
  return datatype.rfind("self_awareness/", 0) == 0;
}

void Siblings::add(const std::string& node, const std::string& datatype) {
  if (!node.empty() && isOwnType(datatype)) {
    nodes_.insert(node);
  }
}

bool Siblings::mayCover(const std::string& topic) {
  return topic == "/rosout" || topic == "/diagnostics";
}

bool Siblings::cover(const std::string& node, const std::string& topic) const {
  return mayCover(topic) && nodes_.count(node) > 0;
}

bool OwnOutput::setGraph(const Graph& graph) {
  Siblings siblings = siblingsIn(graph);
  const bool changed = siblings != siblings_;
  siblings_ = std::move(siblings);
  return changed;
}

bool OwnOutput::covers(const std::string& node, const std::string& topic) const {
  if (node == node_) {
    return Siblings::mayCover(topic) || !knows(node, topic);
  }
  // What the model knows goes on to be judged: a node is not left out because it claims to be one
  // of ours.
  return siblings_.cover(node, topic) && !knows(node, topic);
}

bool OwnOutput::mayCover(const std::string& node, const std::string& topic) const {
  return Siblings::mayCover(topic) && !knows(node, topic);
}

bool OwnOutput::knows(const std::string& node, const std::string& topic) const {
  return encoder_ && known_.count({encoder_->sourceOf(node), encoder_->scopeOf(topic)}) > 0;
}

}  // namespace self_awareness::ros1
