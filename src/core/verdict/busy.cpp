#include "self_awareness/core/verdict/busy.h"

#include <cstdio>

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

}  // namespace self_awareness::core
