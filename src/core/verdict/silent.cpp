#include "self_awareness/core/verdict/silent.h"

#include <algorithm>
#include <cstddef>

namespace self_awareness::core {

bool Silent::has(const std::string& component) const {
  return std::find(components.begin(), components.end(), component) != components.end();
}

std::string describe(const Silent& silent) {
  std::string hosts;
  for (std::size_t k = 0; k < silent.hosts.size(); ++k) {
    hosts += (k == 0 ? "" : k + 1 < silent.hosts.size() ? ", " : " and ") + silent.hosts[k];
  }
  const std::string where =
      hosts.empty() ? "" : (silent.hosts.size() > 1 ? " on hosts " : " on host ") + hosts;
  return "everything" + where + " fell silent: " + std::to_string(silent.components.size()) +
         (hosts.empty() ? " components" : " nodes");
}

}  // namespace self_awareness::core
