#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bag_index.h"
#include "self_awareness/FileVersion.h"
#include "self_awareness/ros/file_version.h"

namespace self_awareness::ros1 {

/// Whether a bag with these connections says of what version it is (docs/monitor.md).
bool tellVersion(const std::vector<Connection>& connections);

/// What a bag says of its version; none: nothing.
/// @throw BagError if that cannot be read
std::optional<self_awareness::FileVersion> versionOfBag(const std::string& path,
                                                        const BagIndex& index);

/// The version of a file of a kind; the first one if it says nothing.
/// @throw BagError if it cannot be read, is that of another kind, or of a version that this one
/// does not read
self_awareness::FileVersion checkedVersion(const std::string& path, const BagIndex& index,
                                           const FileKind& kind);

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

/// The version of a file, without reading the rest of it.
/// @param kind of the file, which is one: a file that says nothing is of its first version
/// @throw BagError if it cannot be read, is damaged, or says that it is of another kind
self_awareness::FileVersion readFileVersion(const std::string& path, const FileKind& kind);

}  // namespace self_awareness::ros1
