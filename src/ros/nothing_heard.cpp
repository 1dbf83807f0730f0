#include "nothing_heard.h"

#include <algorithm>
#include <map>
#include <set>

#include "self_awareness/ros/own_output.h"
#include "self_awareness/ros/stable_name.h"
#include "text.h"

namespace self_awareness::ros1 {
namespace {

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
