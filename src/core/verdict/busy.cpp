#include "self_awareness/core/verdict/busy.h"

namespace self_awareness::core {

std::string describe(const Busy& busy, const std::string& load) {
  return "the machine may be busy" + (load.empty() ? "" : " (" + load + ")") + ": " +
         std::to_string(busy.late) + " of " + std::to_string(busy.components) +
         " components are late";
}

}  // namespace self_awareness::core
