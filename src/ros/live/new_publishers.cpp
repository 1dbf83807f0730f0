#include "self_awareness/ros/live/new_publishers.h"

#include "self_awareness/ros/stable_name.h"

namespace self_awareness::ros1 {

void NewPublishers::restart() {
  started_ = false;
  known_.clear();
}

std::vector<Publisher> NewPublishers::look(
    const Graph& graph, const std::set<std::string>& topics,
    const std::function<bool(const std::string& node, const std::string& topic)>& included) {
  std::vector<Publisher> found;
  for (const auto& [name, topic] : graph.topics) {
    for (const std::string& node : topic.publishers) {
      const Publisher publisher{stableName(node), name};
      if (!started_) {
        known_.insert(publisher);
      } else if (topics.count(name) > 0 && known_.count(publisher) == 0 && included(node, name)) {
        known_.insert(publisher);
        found.push_back(publisher);
      }
    }
  }
  started_ = true;
  return found;
}

}  // namespace self_awareness::ros1
