#include "core/evidence/explain/root_first.h"

#include <algorithm>
#include <numeric>

namespace self_awareness::core::evidence {

std::vector<std::size_t> rootFirst(std::size_t number,
                                   const std::function<bool(std::size_t, std::size_t)>& is_root) {
  std::vector<std::size_t> roots(number, 0);  // of those that are left
  std::vector<std::vector<std::size_t>> victims(number);
  for (std::size_t root = 0; root < number; ++root) {
    for (std::size_t victim = 0; victim < number; ++victim) {
      if (root != victim && is_root(root, victim)) {
        victims[root].push_back(victim);
        ++roots[victim];
      }
    }
  }
  std::vector<std::size_t> ordered;
  std::vector<std::size_t> left(number);
  std::iota(left.begin(), left.end(), 0);
  while (!left.empty()) {
    const auto next =
        std::min_element(left.begin(), left.end(),
                         [&](std::size_t a, std::size_t b) { return roots[a] < roots[b]; });
    ordered.push_back(*next);
    for (const std::size_t victim : victims[*next]) {
      --roots[victim];
    }
    left.erase(next);
  }
  return ordered;
}

}  // namespace self_awareness::core::evidence
