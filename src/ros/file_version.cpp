#include "self_awareness/ros/file_version.h"

#include "text.h"

namespace self_awareness::ros1 {
const char* const kPackageVersion = SELF_AWARENESS_VERSION;

self_awareness::FileVersion versionOf(const FileKind& kind) {
  self_awareness::FileVersion version;
  version.kind = kind.name;
  version.format = kind.format;
  version.oldest_reader = kind.oldest_reader;
  version.method = kind.method;
  version.package = kPackageVersion;
  return version;
}

self_awareness::FileVersion firstVersionOf(const FileKind& kind) {
  self_awareness::FileVersion version = versionOf(kind);
  version.format = 1;
  version.oldest_reader = 1;
  version.method = kind.method == 0 ? 0 : 1;
  version.package = "0.1.0";
  return version;
}

std::string whyUnread(const self_awareness::FileVersion& version, const FileKind& kind) {
  if (version.format < kind.first) {
    return "of format " + std::to_string(version.format) +
           ", which was of no release and is not read any more (format " +
           std::to_string(kind.first) + " is the first one); " + kind.again;
  }
  if (version.oldest_reader <= kind.format) {
    return "";
  }
  return "written by a newer self_awareness (" + printable(version.package, kLongestQuote) +
         ", format " + std::to_string(version.format) + ", for readers of format " +
         std::to_string(version.oldest_reader) + " on; this is " + kPackageVersion + ", format " +
         std::to_string(kind.format) + "); update self_awareness on this machine";
}

}  // namespace self_awareness::ros1
