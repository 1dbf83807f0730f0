#pragma once

#include <cstdint>
#include <string>

#include "self_awareness/FileVersion.h"

namespace self_awareness::ros1 {

/// Version of the method (docs/method.md): a new one where counts, limits or verdicts are others.
/// test/python/evaluation/test_method_version.py tells that they are.
constexpr std::uint32_t kMethod = 6;

/// What this program writes of a kind of file, and so what it reads (docs/files.md).
struct FileKind {
  const char* name;  ///< as in FileVersion.msg
  /// That is written; all before it are read. A new one where a field of a message, or a topic, is
  /// added, dropped, or means something else.
  std::uint32_t format;
  std::uint32_t oldest_reader;  ///< the oldest format whose readers understand what is written
  std::uint32_t method;         ///< that what is in it was made by; 0: by none
};
inline constexpr FileKind kModelFile{"model", 5, 5, kMethod};
inline constexpr FileKind kEventLogFile{"event log", 5, 5, 0};
inline constexpr FileKind kResultBag{"result bag", 2, 1, kMethod};
inline constexpr FileKind kStandingAlarmFile{"standing alarm", 2, 1, 0};
inline constexpr FileKind kIncidentsFile{"incidents", 2, 1, 0};
inline constexpr FileKind kAcceptedFile{"accepted", 2, 2, 0};
inline constexpr FileKind kGraphFile{"graph", 3, 2, 0};  ///< beside bags, in YAML

/// Of this package, as in package.xml: "0.1.0".
extern const char* const kPackageVersion;

constexpr char kVersionTopic[] = "/version";  ///< FileVersion

/// What a file of this kind says that is written now.
self_awareness::FileVersion versionOf(const FileKind& kind);
/// What a file of this kind would say that says nothing: those of release 0.1.0.
self_awareness::FileVersion firstVersionOf(const FileKind& kind);

/// Why a file cannot be read; empty: it can. It is so only if whoever wrote it says that this
/// format's readers are too old.
/// @param version of a file of this kind
std::string whyTooNew(const self_awareness::FileVersion& version, const FileKind& kind);

}  // namespace self_awareness::ros1
