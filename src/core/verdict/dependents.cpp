#include "self_awareness/core/verdict/dependents.h"

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace self_awareness::core {
namespace {

// All nodes write on the first, and who listens there can do without.
const std::set<std::string> kLogTopics{"/rosout", "/rosout_agg"};

/// Who hears a source, but for what it writes into the log.
std::set<std::string> subscribersOf(const SourceGraph& graph, const std::string& publisher) {
  std::set<std::string> subscribers;
  const std::set<SourceGraph::Edge>& edges = graph.edges();
  for (auto edge = edges.lower_bound({publisher, "", ""});
       edge != edges.end() && edge->publisher == publisher; ++edge) {
    if (kLogTopics.count(edge->topic) == 0) {
      subscribers.insert(edge->subscriber);
    }
  }
  return subscribers;
}

}  // namespace

std::set<std::string> dependentsOf(const SourceGraph& graph, const std::string& source,
                                   std::set<std::string> known) {
  std::vector<std::string> ways{source};
  while (!ways.empty()) {
    const std::string publisher = std::move(ways.back());
    ways.pop_back();
    for (const std::string& subscriber : subscribersOf(graph, publisher)) {
      if (known.insert(subscriber).second) {
        ways.push_back(subscriber);
      }
    }
  }
  return known;
}

std::string waitingFor(const SourceGraph& graph, const std::string& source,
                       const std::set<std::string>& silent) {
  std::map<std::string, std::string> waits_for{{source, ""}};
  std::vector<std::string> found{source};  // the nearest first
  for (std::size_t next = 0; next < found.size(); ++next) {
    const std::string publisher = found[next];
    for (const std::string& subscriber : subscribersOf(graph, publisher)) {
      if (silent.count(subscriber) > 0 && waits_for.emplace(subscriber, publisher).second) {
        found.push_back(subscriber);
      }
    }
  }
  std::string words;
  std::size_t named = 0;
  for (std::string waiting = found.back(); waiting != source; waiting = waits_for[waiting]) {
    words +=
        (words.empty() ? waiting + " waits for " : ", " + waiting + " for ") + waits_for[waiting];
    ++named;
  }
  const std::size_t all = found.size() - 1;
  return words + (all > named ? " (" + std::to_string(all) + " nodes wait in all)" : "");
}

}  // namespace self_awareness::core
