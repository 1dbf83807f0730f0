#pragma once

#include <cstddef>
#include <set>
#include <string>

namespace self_awareness::ros1 {

/// What has been complained of already: who makes up new names must not fill the log.
class NamedOnce {
 public:
  /// Further names are not complained of.
  static constexpr std::size_t kMost = 100;

  /// Whether to complain of this name now: the first time, unless there were too many others.
  bool add(const std::string& name) { return names_.size() < kMost && names_.insert(name).second; }

 private:
  std::set<std::string> names_;
};

}  // namespace self_awareness::ros1
