#include "self_awareness/core/verdict/silent.h"

#include <algorithm>
#include <cstddef>

namespace self_awareness::core {
namespace {

constexpr std::size_t kMostNamed = 3;

/// "a, b and c", or "a, b and 4 more".
std::string list(const std::vector<std::string>& names, std::size_t most) {
  const std::size_t shown = std::min(names.size(), most);
  std::string words;
  for (std::size_t k = 0; k < shown; ++k) {
    const bool last = k + 1 == names.size();
    words += (k == 0 ? "" : last ? " and " : ", ") + names[k];
  }
  return shown == names.size() ? words
                               : words + " and " + std::to_string(names.size() - shown) + " more";
}

}  // namespace

bool Silent::has(const std::string& component) const {
  return std::find(components.begin(), components.end(), component) != components.end();
}

std::string describe(const Silent& silent) {
  if (silent.others_go_on) {
    return list(silent.components, kMostNamed) +
           " stopped together, and others go on: a mode that training did not show, or something "
           "that they share";
  }
  std::string where;
  if (!silent.hosts.empty()) {
    where = (silent.hosts.size() > 1 ? " on hosts " : " on host ") +
            list(silent.hosts, silent.hosts.size());
  }
  return "everything" + where + " fell silent: " + std::to_string(silent.components.size()) +
         (silent.hosts.empty() ? " components" : " nodes");
}

}  // namespace self_awareness::core
