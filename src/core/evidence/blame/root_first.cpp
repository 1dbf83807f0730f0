#include "core/evidence/blame/root_first.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace self_awareness::core::evidence {

// Components are compared, not what is said of them: when a whole robot falls silent, every event
// type is a candidate, but there are few components.
std::vector<std::size_t> rootFirst(
    const std::vector<std::string>& components,
    const std::function<bool(const std::string&, const std::string&)>& is_upstream) {
  std::map<std::string, std::vector<std::size_t>> by_component;
  for (std::size_t i = 0; i < components.size(); ++i) {
    by_component[components[i]].push_back(i);
  }
  std::vector<std::size_t> upstream(components.size(), 0);  // number of those left that are
  std::map<std::string, std::vector<std::size_t>> downstream;
  for (const auto& [name, members] : by_component) {
    for (const auto& [other, victims] : by_component) {
      if (is_upstream(name, other)) {
        downstream[name].insert(downstream[name].end(), victims.begin(), victims.end());
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
