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

}  // namespace self_awareness::ros1
