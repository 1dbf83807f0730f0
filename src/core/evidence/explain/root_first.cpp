#include "core/evidence/explain/root_first.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace self_awareness::core::evidence {

// Components are compared, not what is said of them: when a whole robot falls silent, every event
// type is a candidate, but there are few components.
std::vector<std::size_t> rootFirst(
    const std::vector<std::size_t>& components,
    const std::function<bool(std::size_t, std::size_t)>& is_upstream) {
  std::map<std::size_t, std::vector<std::size_t>> by_component;  // places in `components`
  for (std::size_t i = 0; i < components.size(); ++i) {
    by_component[components[i]].push_back(i);
  }
  std::vector<std::size_t> upstream(components.size(), 0);  // number of those left that are
  std::map<std::size_t, std::vector<std::size_t>> downstream;
  for (const auto& [component, members] : by_component) {
    for (const auto& [other, victims] : by_component) {
      if (is_upstream(component, other)) {
        std::vector<std::size_t>& its_victims = downstream[component];
        its_victims.insert(its_victims.end(), victims.begin(), victims.end());
        for (const std::size_t victim : victims) {
          upstream[victim] += members.size();
        }
      }
    }
  }
  std::vector<std::size_t> ordered;
  std::vector<std::size_t> left(components.size());
  std::iota(left.begin(), left.end(), 0);
  while (!left.empty()) {
    const auto root =
        std::min_element(left.begin(), left.end(),
                         [&](std::size_t a, std::size_t b) { return upstream[a] < upstream[b]; });
    ordered.push_back(*root);
    for (const std::size_t victim : downstream[components[*root]]) {
      --upstream[victim];
    }
    left.erase(root);
  }
  return ordered;
}

}  // namespace self_awareness::core::evidence
