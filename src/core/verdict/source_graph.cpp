#include "self_awareness/core/verdict/source_graph.h"

#include <utility>
#include <vector>

namespace self_awareness::core {

void SourceGraph::connect(const std::string& publisher, const std::string& topic,
                          const std::string& subscriber) {
  edges_.insert({publisher, topic, subscriber});
  followers_[publisher].insert(subscriber);
}

const std::string& SourceGraph::hostOf(const std::string& source) const {
  static const std::string unknown;
  const auto known = hosts_.find(source);
  return known == hosts_.end() ? unknown : known->second;
}

bool SourceGraph::isUpstream(const std::string& from, const std::string& to) const {
  const std::optional<std::size_t> there = distance(from, to);
  const std::optional<std::size_t> back = distance(to, from);
  return from != to && there && (!back || *there < *back);
}

std::optional<std::size_t> SourceGraph::distance(const std::string& from,
                                                 const std::string& to) const {
  std::set<std::string> seen{from};
  std::vector<std::string> reached{from};
  for (std::size_t steps = 1; !reached.empty(); ++steps) {
    std::vector<std::string> next;
    for (const std::string& source : reached) {
      const auto followers = followers_.find(source);
      if (followers == followers_.end()) {
        continue;
      }
      if (followers->second.count(to) > 0) {
        return steps;
      }
      for (const std::string& follower : followers->second) {
        if (seen.insert(follower).second) {
          next.push_back(follower);
        }
      }
    }
    reached = std::move(next);
  }
  return std::nullopt;
}

}  // namespace self_awareness::core
