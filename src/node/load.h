#pragma once

#include <string>

namespace self_awareness {

/// The load of this machine during the last minute: "load 7.9 on 2 cores"; empty if the system
/// does not tell.
std::string loadInWords();

}  // namespace self_awareness
