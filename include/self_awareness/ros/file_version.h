#pragma once

#include <cstdint>
#include <string>

#include "self_awareness/FileVersion.h"

namespace self_awareness::ros1 {

/// Version of the method (docs/method.md): a new one where counts, limits or verdicts are others.
/// test/python/evaluation/test_method_version.py tells that they are.
constexpr std::uint32_t kMethod = 20;

/// What this program writes of a kind of file, and so what it reads (docs/monitor.md).
struct FileKind {
  const char* name;  ///< as in FileVersion.msg
  /// That is written; all from `first` on are read. A new one where a field, or a topic, is added,
  /// dropped, or means something else.
  std::uint32_t format;
  std::uint32_t oldest_reader;  ///< the oldest format whose readers understand what is written
  std::uint32_t method;         ///< that what is in it was made by; 0: by none
  std::uint32_t first = 1;      ///< the oldest format that is read
  const char* again = "";       ///< how to get a file of this format for an older one
};
/// Formats 1 to 7 of models were of no release.
inline constexpr FileKind kModelFile{"model", 8, 8,
                                     kMethod, 8, "train it again (rosrun self_awareness train)"};
inline constexpr FileKind kEventLogFile{"event log", 6, 5, 0};
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
/// What a file of this kind would say that says nothing: it is of before versions were told.
self_awareness::FileVersion firstVersionOf(const FileKind& kind);

/// Why a file cannot be read; empty: it can. Whoever wrote it says that this format's readers are
/// too old, or its format was of no release.
/// @param version of a file of this kind
std::string whyUnread(const self_awareness::FileVersion& version, const FileKind& kind);

}  // namespace self_awareness::ros1
