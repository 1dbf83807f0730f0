#include "self_awareness/ros/graph.h"

#include <ros/network.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <algorithm>
#include <iterator>

#include "master_calls.h"
#include "self_awareness/ros/stable_name.h"
#include "text.h"

namespace self_awareness::ros1 {
namespace {

// An entry of the master's state: [topic, [node, ...]].
void addNodes(XmlRpc::XmlRpcValue& entries, std::set<std::string> Graph::Topic::*nodes,
              Graph& graph) {
  for (int i = 0; i < entries.size(); ++i) {
    std::set<std::string>& names = graph.topics[printable(std::string(entries[i][0]))].*nodes;
    for (int k = 0; k < entries[i][1].size(); ++k) {
      names.insert(printable(std::string(entries[i][1][k])));
    }
  }
}

std::set<core::SourceGraph::Subscription> subscriptionsOf(const Graph& graph,
                                                          const Encoder& encoder) {
  std::set<core::SourceGraph::Subscription> subscriptions;
  for (const auto& [name, topic] : graph.topics) {
    for (const std::string& node : topic.subscribers) {
      if (encoder.includesTopic(name) && encoder.listens(stableName(node))) {
        subscriptions.emplace(encoder.sourceOf(node), encoder.scopeOf(name));
      }
    }
  }
  return subscriptions;
}

/// What is published there is about all that run, whether that is a robot or not.
const std::set<std::string> kOfEverybody{"/rosout",
                                         "/rosout_agg",
                                         "/clock",
                                         "/statistics",
                                         "/diagnostics",
                                         "/diagnostics_agg",
                                         "/diagnostics_toplevel_state"};

std::string some(const std::set<std::string>& topics) {
  return printable(*topics.begin(), kLongestQuote) +
         (topics.size() > 1 ? " and " + std::to_string(topics.size() - 1) + " more" : "");
}

std::string playersIn(const Graph& graph, const Encoder& encoder) {
  std::map<std::string, std::size_t> topics;
  for (const core::EventType& played : playedIn(graph, encoder)) {
    ++topics[played.source];
  }
  std::string words;
  for (const auto& [player, number] : topics) {
    words += (words.empty() ? "" : "; ") + printable(player, kLongestQuote) + " plays " +
             std::to_string(number) + (number == 1 ? " topic" : " topics") +
             "; players are left out: use `score BAG` or `train BAG`, or `source: none` in the "
             "encoding";
  }
  return words;
}

}  // namespace

bool operator==(const Graph& a, const Graph& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.first == y.first && x.second.datatype == y.second.datatype &&
           x.second.publishers == y.second.publishers &&
           x.second.subscribers == y.second.subscribers;
  };
  return a.hosts == b.hosts && a.addresses == b.addresses &&
         std::equal(a.topics.begin(), a.topics.end(), b.topics.begin(), b.topics.end(), same);
}

void forEachGraph(const std::vector<GraphChange>& changes,
                  const std::function<void(std::int64_t, const Graph&)>& handler) {
  Graph graph;
  for (const GraphChange& change : changes) {
    for (const auto& [name, topic] : change.topics) {
      graph.topics[name] = topic;
    }
    handler(change.stamp, graph);
  }
}

std::optional<SystemState> fetchSystemState() {
  std::vector<std::optional<XmlRpc::XmlRpcValue>> answers =
      callMaster({{"getSystemState"}, {"getTopicTypes"}});
  std::optional<XmlRpc::XmlRpcValue>& state = answers[0];
  std::optional<XmlRpc::XmlRpcValue>& types = answers[1];
  if (!state || !types) {
    return std::nullopt;
  }
  try {
    SystemState known;
    Graph& graph = known.graph;
    addNodes((*state)[0], &Graph::Topic::publishers, graph);
    addNodes((*state)[1], &Graph::Topic::subscribers, graph);
    for (int i = 0; i < types->size(); ++i) {
      const auto topic = graph.topics.find(printable(std::string((*types)[i][0])));
      if (topic != graph.topics.end()) {
        topic->second.datatype = printable(std::string((*types)[i][1]));
      }
    }
    for (int i = 0; i < (*state)[2].size(); ++i) {
      known.services.insert(printable(std::string((*state)[2][i][0])));
    }
    return known;
  } catch (const XmlRpc::XmlRpcException&) {
    return std::nullopt;  // not what a master answers
  }
}

std::map<std::string, std::string> fetchAddresses(const std::set<std::string>& nodes) {
  std::vector<MasterCall> calls;
  for (const std::string& node : nodes) {
    calls.push_back({"lookupNode", {node}});
  }
  std::vector<std::optional<XmlRpc::XmlRpcValue>> answers = callMaster(calls);
  std::map<std::string, std::string> addresses;
  auto answer = answers.begin();
  for (const std::string& node : nodes) {
    if (*answer && (*answer)->getType() == XmlRpc::XmlRpcValue::TypeString) {
      addresses[node] = static_cast<std::string>(**answer);
    }
    ++answer;
  }
  return addresses;
}

Siblings siblingsIn(const Graph& graph) {
  Siblings siblings;
  for (const auto& [name, topic] : graph.topics) {
    for (const std::string& publisher : topic.publishers) {
      siblings.add(publisher, topic.datatype);
    }
  }
  return siblings;
}

Graph withoutSiblings(Graph graph) {
  const Siblings siblings = siblingsIn(graph);
  const auto strip = [&](std::set<std::string>& nodes) {
    for (auto node = nodes.begin(); node != nodes.end();) {
      node = siblings.has(*node) ? nodes.erase(node) : std::next(node);
    }
  };
  for (auto topic = graph.topics.begin(); topic != graph.topics.end();) {
    strip(topic->second.publishers);
    strip(topic->second.subscribers);
    const bool empty = topic->second.publishers.empty() && topic->second.subscribers.empty();
    topic = empty ? graph.topics.erase(topic) : std::next(topic);
  }
  return graph;
}

std::set<core::SourceGraph::Publication> unheardIn(const Graph& graph, const Encoder& encoder) {
  std::set<core::SourceGraph::Publication> unheard;
  for (const auto& [name, topic] : graph.topics) {
    if (!encoder.includesTopic(name) ||
        std::any_of(topic.subscribers.begin(), topic.subscribers.end(),
                    [&](const std::string& node) { return encoder.listens(stableName(node)); })) {
      continue;
    }
    for (const std::string& publisher : topic.publishers) {
      if (encoder.includesSource(stableName(publisher))) {
        unheard.emplace(encoder.tellsSources() ? encoder.sourceOf(publisher) : "",
                        encoder.scopeOf(name));
      }
    }
  }
  return unheard;
}

std::set<core::SourceGraph::Subscription> subscriptionsIn(const Graph& graph,
                                                          const Encoder& encoder) {
  return subscriptionsOf(withoutSiblings(graph), encoder);
}

std::set<core::SourceGraph::Subscription> missingIn(
    const Graph& graph, const Encoder& encoder,
    const std::set<core::SourceGraph::Subscription>& expected) {
  std::set<core::SourceGraph::Subscription> missing;
  if (expected.empty()) {
    return missing;
  }
  std::set<std::string> sources;
  for (const auto& [name, topic] : graph.topics) {
    for (const std::set<std::string>* nodes : {&topic.publishers, &topic.subscribers}) {
      for (const std::string& node : *nodes) {
        sources.insert(encoder.sourceOf(node));
      }
    }
  }
  // A monitor in a manager of the robot has its name: what is there is there.
  const std::set<core::SourceGraph::Subscription> present = subscriptionsOf(graph, encoder);
  std::copy_if(expected.begin(), expected.end(), std::inserter(missing, missing.end()),
               [&](const core::SourceGraph::Subscription& each) {
                 return sources.count(each.first) > 0 && present.count(each) == 0;
               });
  return missing;
}

std::set<core::EventType> playedIn(const Graph& graph, const Encoder& encoder) {
  std::set<core::EventType> played;
  for (const auto& [name, topic] : graph.topics) {
    for (const std::string& node : topic.publishers) {
      if (const auto type = encoder.played({node, name, topic.datatype})) {
        played.insert(*type);
      }
    }
  }
  return played;
}

std::string hostIn(const std::string& uri) {
  std::string host;
  std::uint32_t port = 0;
  return ros::network::splitURI(uri, host, port) ? printable(host) : "";
}

void addEdges(const Graph& graph, const std::string& own_name, const Encoder& encoder,
              core::SourceGraph& edges) {
  for (const auto& [name, topic] : withoutSiblings(graph).topics) {
    for (const std::string& publisher : topic.publishers) {
      for (const std::string& subscriber : topic.subscribers) {
        if (publisher != own_name && subscriber != own_name && edges.edges().size() < kMostEdges) {
          edges.connect(encoder.sourceOf(publisher), encoder.scopeOf(name),
                        encoder.sourceOf(subscriber));
        }
      }
    }
  }
  std::map<std::string, std::set<std::string>> hosts;
  for (const auto& [node, host] : graph.hosts) {
    hosts[encoder.sourceOf(node)].insert(host);
  }
  for (const auto& [source, all] : hosts) {
    if (edges.hosts().size() < kMostHosts) {
      edges.place(source, all.size() == 1 ? *all.begin() : "");
    }
  }
}

std::set<std::string> chooseTopics(const Graph& graph, SubscribePolicy policy,
                                   const std::set<std::string>& model_topics,
                                   const std::function<bool(const std::string&)>& included,
                                   const std::function<bool(const std::string&)>& listens) {
  std::set<std::string> chosen;
  std::copy_if(model_topics.begin(), model_topics.end(), std::inserter(chosen, chosen.end()),
               [](const std::string& topic) { return whyLeftOut(topic).empty(); });
  if (policy == SubscribePolicy::kModel) {
    return chosen;
  }
  for (const auto& [name, topic] : graph.topics) {
    const bool used = std::any_of(topic.subscribers.begin(), topic.subscribers.end(), listens);
    if (!topic.publishers.empty() && (policy == SubscribePolicy::kAll || used) && included(name)) {
      chosen.insert(name);
    }
  }
  return chosen;
}

std::string whyNothingIsHeard(const Graph& graph, const Encoder& encoder, bool used_only) {
  const Siblings siblings = siblingsIn(graph);
  const auto is_of_robot = [&](const std::string& node) {
    return !siblings.has(node) && encoder.includesSource(stableName(node));
  };
  std::set<std::string> published;
  std::set<std::string> used;
  for (const auto& [name, topic] : graph.topics) {
    if (kOfEverybody.count(name) == 0 && encoder.includesTopic(name) &&
        std::any_of(topic.publishers.begin(), topic.publishers.end(), is_of_robot)) {
      published.insert(name);
      if (std::any_of(topic.subscribers.begin(), topic.subscribers.end(), is_of_robot)) {
        used.insert(name);
      }
    }
  }
  if (published.empty()) {
    const std::string players = playersIn(graph, encoder);
    return players.empty() ? "no node of a robot publishes anything" : players;
  }
  if (used_only && used.empty()) {
    return "no node of the robot subscribes to " + some(published) +
           "; launch it with subscribe:=all to listen all the same";
  }
  return "nothing is sent on " + some(used.empty() ? published : used);
}

}  // namespace self_awareness::ros1
