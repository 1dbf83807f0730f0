#include "self_awareness/core/verdict/silent.h"

#include <algorithm>
#include <cstddef>

#include "core/verdict/name_list.h"

namespace self_awareness::core {
namespace {

constexpr std::size_t kMostOfSilent = 3;

}  // namespace

bool Silent::has(const std::string& component) const {
  return std::find(components.begin(), components.end(), component) != components.end();
}

std::string describe(const Silent& silent) {
  if (silent.others_go_on) {
    return listed(silent.components, kMostOfSilent) +
           " stopped together, and others go on: a mode that training did not show, or something "
           "that they share";
  }
  std::string where;
  if (!silent.hosts.empty()) {
    where = (silent.hosts.size() > 1 ? " on hosts " : " on host ") +
            listed(silent.hosts, silent.hosts.size());
  }
  return "everything" + where + " fell silent: " + std::to_string(silent.components.size()) +
         (silent.hosts.empty() ? " components" : " nodes");
}

}  // namespace self_awareness::core
