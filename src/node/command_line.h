#pragma once

#include <string>

namespace self_awareness {

/// Answers --help and --version of a node, at once and without a master.
/// @param usage what --help prints
/// @return whether the arguments asked for one of them
bool answered(int argc, char** argv, const std::string& usage);

}  // namespace self_awareness
