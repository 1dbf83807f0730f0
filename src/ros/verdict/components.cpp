#include "components.h"

#include <map>
#include <string>

#include "self_awareness/ros/own_output.h"

namespace self_awareness::ros1 {
namespace {

using core::evidence::Coverage;
using self_awareness::ComponentState;

double sumOf(const std::map<std::string, double>& rates) {
  double sum = 0;
  for (const auto& [topic, rate] : rates) {
    sum += rate;
  }
  return sum;
}

ComponentState stateOf(const CommunicationState& state, const std::string& name,
                       const Coverage* coverage) {
  const HeardReport::Component& heard = state.heard.components.at(name);
  diagnostic_updater::DiagnosticStatusWrapper status;
  tellComponent(state, name, coverage, status);
  const auto usual = state.expected.find(name);
  const auto share = state.shares.find(name);
  ComponentState component;
  component.name = name;
  component.level = status.level;
  component.state = status.message;
  component.rate = sumOf(heard.rates);
  component.usual_rate = usual == state.expected.end() ? 0 : sumOf(usual->second);
  component.age = heard.last_heard.value_or(-1);
  component.share = share == state.shares.end() ? -1 : share->second;
  component.found_after = component.found_when_asked = -1;
  if (coverage != nullptr) {
    component.found_after = coverage->death_found_after.value_or(-1);
    component.found_when_asked = coverage->found_when_asked.value_or(-1);
    component.not_watched = whyNotWatched(*coverage);
  }
  return component;
}

// Of a node that the model does not know.
ComponentState unknown(const std::string& name, const std::string& why) {
  ComponentState component;
  component.name = name;
  component.state = "in the graph";
  component.age = component.share = component.found_after = component.found_when_asked = -1;
  component.not_watched = why;
  return component;
}

// Why a node of the graph is not watched, by the names of components.
std::map<std::string, std::string> whyUnknown(const Graph& graph, const Encoder& encoder) {
  const Siblings siblings = siblingsIn(graph);
  std::map<std::string, std::string> why;
  const auto name = [&](const std::string& node, const std::string& reason) {
    if (!siblings.has(node)) {
      why.try_emplace(encoder.sourceOf(node), reason);
    }
  };
  for (const auto& [topic, nodes] : graph.topics) {
    for (const std::string& node : nodes.publishers) {
      if (topic != "/rosout" && encoder.includesTopic(topic)) {
        name(node, "training never heard it");
      }
    }
  }
  for (const auto& [topic, nodes] : graph.topics) {
    for (const std::string& node : nodes.publishers) {
      name(node, "it publishes nothing that is listened to");
    }
  }
  for (const auto& [topic, nodes] : graph.topics) {
    for (const std::string& node : nodes.subscribers) {
      name(node, "it publishes nothing");
    }
  }
  return why;
}

}  // namespace

self_awareness::Components toComponents(const CommunicationState& state, const Graph* graph,
                                        const Encoder& encoder) {
  std::map<std::string, ComponentState> components;
  std::map<std::string, const Coverage*> coverage;
  for (const Coverage& each : state.coverage) {
    coverage[each.component] = &each;
  }
  for (const auto& [name, heard] : state.heard.components) {
    components[name] = stateOf(state, name, coverage[name]);
  }
  if (graph != nullptr && encoder.tellsSources()) {
    for (const auto& [node, why] : whyUnknown(*graph, encoder)) {
      components.try_emplace(node, unknown(node, why));
    }
  }
  self_awareness::Components message;
  message.model = state.model;
  for (auto& [name, component] : components) {
    message.components.push_back(std::move(component));
  }
  for (const CommunicationState::Stranger& each : state.strangers) {
    self_awareness::Acceptance stranger;
    stranger.component = each.source;
    stranger.topic = each.topic;
    stranger.kind = self_awareness::SelfAwareness::STRANGER;
    message.strangers.push_back(stranger);
  }
  message.watched_less = state.watched_less;
  message.off_together = state.mode;
  return message;
}

}  // namespace self_awareness::ros1
