#pragma once

#include <set>
#include <string>

#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core {

/// Who needs messages of a source, directly or through others: its victims, when it fails. Nobody
/// needs what others write into the log (/rosout).
std::set<std::string> dependentsOf(const SourceGraph& graph, const std::string& source);

}  // namespace self_awareness::core
