#pragma once

#include <string>

#include "self_awareness/ros/file_version.h"

namespace self_awareness::ros1 {

/// The version of a file, without reading the rest of it.
/// @param kind of the file, which is one: a file that says nothing is of its first version
/// @throw BagError if it cannot be read, is damaged, or says that it is of another kind
self_awareness::FileVersion readFileVersion(const std::string& path, const FileKind& kind);

}  // namespace self_awareness::ros1
