#include "nothing_heard.h"

#include <set>

#include "ros/text.h"
#include "self_awareness/ros/stable_name.h"

namespace self_awareness {
namespace {

constexpr std::size_t kMostOfName = 100;  // bytes

}  // namespace

std::string whyNothingIsHeard(const ros1::Graph* graph, const ros1::Encoder& encoder) {
  if (graph == nullptr) {
    return "the master has not said who publishes";
  }
  const std::set<core::EventType> played = ros1::playedIn(*graph, encoder);
  if (!played.empty()) {
    return ros1::printable(played.begin()->source, kMostOfName) + " plays " +
           std::to_string(played.size()) +
           " topics; players are left out: use `score BAG`, or a model with `source: none`";
  }
  const ros1::Siblings siblings = ros1::siblingsIn(*graph);
  std::set<std::string> publishers;
  for (const auto& [topic, nodes] : graph->topics) {
    for (const std::string& node : nodes.publishers) {
      if (topic != "/rosout" && encoder.includesTopic(topic) && !siblings.has(node) &&
          encoder.includesSource(ros1::stableName(node))) {
        publishers.insert(node);
      }
    }
  }
  return publishers.empty()
             ? "nobody publishes: is the robot started?"
             : "nothing comes on what is listened to, of " + std::to_string(publishers.size()) +
                   (publishers.size() == 1 ? " node that publishes" : " nodes that publish");
}

}  // namespace self_awareness
