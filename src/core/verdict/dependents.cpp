#include "self_awareness/core/verdict/dependents.h"

#include <utility>
#include <vector>

namespace self_awareness::core {
namespace {

// All nodes write on the first, and who listens there can do without.
const std::set<std::string> kLogTopics{"/rosout", "/rosout_agg"};

}  // namespace

std::set<std::string> dependentsOf(const SourceGraph& graph, const std::string& source) {
  std::set<std::string> reached;
  std::vector<std::string> ways{source};
  while (!ways.empty()) {
    const std::string publisher = std::move(ways.back());
    ways.pop_back();
    const std::set<SourceGraph::Edge>& edges = graph.edges();
    for (auto edge = edges.lower_bound({publisher, "", ""});
         edge != edges.end() && edge->publisher == publisher; ++edge) {
      if (kLogTopics.count(edge->topic) == 0 && reached.insert(edge->subscriber).second) {
        ways.push_back(edge->subscriber);
      }
    }
  }
  return reached;
}

}  // namespace self_awareness::core
