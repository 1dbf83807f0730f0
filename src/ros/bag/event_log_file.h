#pragma once

#include <string>
#include <vector>

#include "bag_index.h"

namespace self_awareness::ros1 {

/// Whether a connection holds messages that make up an event log.
bool isOfEventLog(const Connection& connection);

/// Whether a bag with these connections may be an event log; that takes no time even where the bag
/// is large.
bool mayBeEventLog(const std::vector<Connection>& connections);

/// Whether a bag is an event log: by what it says of itself (docs/monitor.md), or because there is
/// nothing else in it. What this version does not know may be in a log of a newer one only: in any
/// other bag, somebody has recorded the topics of a log beside his own.
/// @param index of the bag
/// @throw BagError if the bag says of what version it is, but that cannot be read
bool isEventLog(const std::string& path, const BagIndex& index);

}  // namespace self_awareness::ros1
