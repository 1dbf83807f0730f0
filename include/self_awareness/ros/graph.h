#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::ros1 {

/// Who publishes and subscribes what, as the master knows it. A dead node stays in it: being
/// registered says nothing about life.
struct Graph {
  struct Topic {
    std::string datatype;  ///< "" or "*" if nobody said it yet
    std::set<std::string> publishers;
    std::set<std::string> subscribers;
  };
  std::map<std::string, Topic> topics;
};

bool operator==(const Graph& a, const Graph& b);

/// Asks the master. Blocks for as long as it takes to answer; none if it does not.
std::optional<Graph> fetchGraph();

/// Adds an edge from every publisher of a topic to every subscriber, by their stable names.
/// @param own_name of a node that listens to everything, and is left out
void addEdges(const Graph& graph, const std::string& own_name, core::SourceGraph& edges);

/// Which topics to listen to besides those of the model.
enum class SubscribePolicy {
  kUsed,  ///< those that somebody else listens to: subscribing wakes no lazy publisher
  kAll,   ///< all that are published
  kModel  ///< none
};

/// The topics to subscribe to: all of the model, whether they are published yet or not, and others
/// by the policy, as far as the encoding includes them.
/// @param own_name the subscriber's node name, which does not count as somebody else
std::set<std::string> chooseTopics(const Graph& graph, SubscribePolicy policy,
                                   const std::set<std::string>& model_topics,
                                   const std::function<bool(const std::string&)>& included,
                                   const std::string& own_name);

}  // namespace self_awareness::ros1
