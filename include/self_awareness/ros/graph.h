#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/own_output.h"

namespace self_awareness::ros1 {

/// Who publishes and subscribes to what, as the master knows it. A dead node stays in the graph:
/// the master does not notice its death.
struct Graph {
  struct Topic {
    std::string datatype;  ///< "" or "*" if no node has said it yet
    std::set<std::string> publishers;
    std::set<std::string> subscribers;
  };
  std::map<std::string, Topic> topics;
  /// URIs of the XML-RPC servers of those that are listened to, by node.
  std::map<std::string, std::string> addresses;
  std::map<std::string, std::string> hosts;  ///< names or addresses of computers, by node
};

bool operator==(const Graph& a, const Graph& b);

/// What changed in a graph at a time; at first, all of it.
struct GraphChange {
  std::int64_t stamp = 0;                      ///< [ns]
  std::map<std::string, Graph::Topic> topics;  ///< as they are from then on
};

/// Calls the handler with the graph from each change on, and its time [ns].
void forEachGraph(const std::vector<GraphChange>& changes,
                  const std::function<void(std::int64_t, const Graph&)>& handler);

/// What the master knows.
struct SystemState {
  Graph graph;
  std::set<std::string> services;  ///< that somebody offers
};

/// Asks the master, and blocks until it answers; none if it does not.
std::optional<SystemState> fetchSystemState();

/// Asks the master for the URIs of nodes' XML-RPC servers, and blocks until it answers.
/// @return by node; without those that the master does not know
std::map<std::string, std::string> fetchAddresses(const std::set<std::string>& nodes);

/// The nodes of this package that are in it, as far as it knows the types of topics.
Siblings siblingsIn(const Graph& graph);
/// The same without the nodes of this package: they look at the robot, and are no part of it.
Graph withoutSiblings(Graph graph);

/// What nodes publish, and the encoding includes, and no node of the robot subscribes to.
/// @param graph without the nodes of this package
std::set<core::SourceGraph::Publication> unheardIn(const Graph& graph, const Encoder& encoder);

/// Who of the robot subscribes to what, by stable names, of the topics that the encoding includes.
std::set<core::SourceGraph::Subscription> subscriptionsIn(const Graph& graph,
                                                          const Encoder& encoder);

/// Which subscriptions are missing, although the node that should have them is in the graph. Who
/// is not there at all is silent, too; and one that was killed keeps its subscriptions.
std::set<core::SourceGraph::Subscription> missingIn(
    const Graph& graph, const Encoder& encoder,
    const std::set<core::SourceGraph::Subscription>& expected);

/// What players publish on topics of the robot (SenderWatch): types whose sources are the players.
std::set<core::EventType> playedIn(const Graph& graph, const Encoder& encoder);

/// The name or the address in the URI of a node's XML-RPC server; empty: there is none.
std::string hostIn(const std::string& uri);

/// Most computers of sources that are kept.
constexpr std::size_t kMostHosts = 20000;

/// Most edges that are kept: what is new then is left out. They name roots, no more, and a robot
/// of 300 nodes with all of tf and /rosout has some ten thousand.
constexpr std::size_t kMostEdges = 50000;

/// Adds an edge from every publisher of a topic to every subscriber, by the names that events give
/// them, and the computers of all (docs/method.md, section 6). Nodes of this package are left out,
/// since they may listen to everything.
/// @param own_name name of this node, which is one of them
void addEdges(const Graph& graph, const std::string& own_name, const Encoder& encoder,
              core::SourceGraph& edges);

/// Topics to subscribe to besides those of the model.
enum class SubscribePolicy {
  kUsed,  ///< those that a node of the robot listens to: so no lazy publisher wakes up
  kAll,   ///< all that are published
  kModel  ///< none
};

/// Topics to subscribe to: all of the model, even if they are not published yet, and others by the
/// policy if the encoding includes them. Those that roscpp cannot subscribe to are left out.
/// @param listens whether a node, by its full name, is one of the robot that listens: neither this
/// one nor a tool is
std::set<std::string> chooseTopics(const Graph& graph, SubscribePolicy policy,
                                   const std::set<std::string>& model_topics,
                                   const std::function<bool(const std::string&)>& included,
                                   const std::function<bool(const std::string&)>& listens);

/// Why nothing of a robot is heard, in words.
/// @param graph who publishes and who subscribes
/// @param used_only whether only what a node of the robot subscribes to is listened to
std::string whyNothingIsHeard(const Graph& graph, const Encoder& encoder, bool used_only);

}  // namespace self_awareness::ros1
