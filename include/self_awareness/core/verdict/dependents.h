#pragma once

#include <set>
#include <string>

#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core {

/// Who needs messages of a source, directly or through others: its victims, when it fails. Nobody
/// needs what others write into the log (/rosout).
/// @param known those of other sources, which are returned, too, and not looked for again
std::set<std::string> dependentsOf(const SourceGraph& graph, const std::string& source,
                                   std::set<std::string> known = {});

/// Who waits for whom, from the one that is farthest from a source back to it: "/costmap waits for
/// /filter, /filter for /lidar (3 nodes wait in all)"; empty: nobody does.
/// @param silent the sources that may wait
std::string waitingFor(const SourceGraph& graph, const std::string& source,
                       const std::set<std::string>& silent);

}  // namespace self_awareness::core
