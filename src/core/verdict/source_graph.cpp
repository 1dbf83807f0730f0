#include "self_awareness/core/verdict/source_graph.h"

#include <limits>

namespace self_awareness::core {
namespace {

constexpr std::size_t kNoWay = std::numeric_limits<std::size_t>::max();

/// Numbers of steps from one place to all.
std::vector<std::size_t> stepsFrom(std::size_t from,
                                   const std::vector<std::vector<std::size_t>>& followers) {
  std::vector<std::size_t> steps(followers.size(), kNoWay);
  std::vector<std::size_t> reached{from};
  steps[from] = 0;
  for (std::size_t k = 0; k < reached.size(); ++k) {
    for (const std::size_t follower : followers[reached[k]]) {
      if (steps[follower] == kNoWay) {
        steps[follower] = steps[reached[k]] + 1;
        reached.push_back(follower);
      }
    }
  }
  return steps;
}

}  // namespace

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

std::vector<std::vector<bool>> SourceGraph::upstream(
    const std::vector<std::string>& sources) const {
  std::map<std::string, std::size_t> places;
  for (const std::string& source : sources) {
    places.emplace(source, places.size());
  }
  std::vector<std::vector<std::size_t>> followers(places.size());
  const auto placeOf = [&](const std::string& source) {
    const auto [place, is_new] = places.emplace(source, places.size());
    if (is_new) {
      followers.emplace_back();
    }
    return place->second;
  };
  for (const auto& [publisher, its_followers] : followers_) {
    const std::size_t from = placeOf(publisher);
    for (const std::string& follower : its_followers) {
      const std::size_t to = placeOf(follower);
      followers[from].push_back(to);
    }
  }
  std::vector<std::vector<std::size_t>> steps;
  for (std::size_t from = 0; from < sources.size(); ++from) {
    steps.push_back(stepsFrom(from, followers));
  }
  std::vector<std::vector<bool>> upstream(sources.size(), std::vector<bool>(sources.size()));
  for (std::size_t from = 0; from < sources.size(); ++from) {
    for (std::size_t to = 0; to < sources.size(); ++to) {
      upstream[from][to] = steps[from][to] < steps[to][from];
    }
  }
  return upstream;
}

}  // namespace self_awareness::core
