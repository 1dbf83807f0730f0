#pragma once

#include <optional>
#include <string>

#include "self_awareness/core/verdict/acceptance.h"

namespace self_awareness::ros1 {

/// The file of what is accepted beside a model (docs/live.md).
std::string pathOfAccepted(const std::string& model);

/// Writes the whole file or nothing (see OutputFile).
/// @throw FileError or BagError if it cannot be written
void writeAccepted(const core::Acceptances& accepted, const std::string& path);

/// Reads such a file, and checks what is in it.
/// @return none: there is no file
/// @throw BagError if it is damaged, or no such file; names it
std::optional<core::Acceptances> readAccepted(const std::string& path);

}  // namespace self_awareness::ros1
