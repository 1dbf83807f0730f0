#include "self_awareness/core/verdict/shared_cause.h"

#include <algorithm>
#include <cstdio>

#include "core/verdict/name_list.h"

namespace self_awareness::core {

std::string describe(const Busy& busy, const std::string& load) {
  std::string words = "the machine may be busy";
  if (busy.starved > 0) {
    char text[60];
    std::snprintf(text, sizeof text, "the machine has been starved for %.1f s", busy.starved);
    words = text;
  }
  words += load.empty() ? "" : " (" + load + ")";
  if (busy.late > 0) {
    words += ": " + std::to_string(busy.late) + " of " + std::to_string(busy.components) +
             " components are late";
  }
  return words;
}

bool Silent::has(const std::string& component) const {
  return std::find(components.begin(), components.end(), component) != components.end();
}

std::string describe(const Silent& silent) {
  constexpr std::size_t kMostNamed = 3;
  if (silent.others_go_on) {
    return listed(silent.components, kMostNamed) +
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
