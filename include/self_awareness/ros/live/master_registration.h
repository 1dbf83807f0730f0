#pragma once

#include <optional>
#include <string>
#include <vector>

namespace self_awareness::ros1 {

/// Registers this process's topics and services again after a restart of the master, which roscpp
/// does not do: without that, no other node finds them, and they find no new node. Connections
/// that exist are left alone; they do not need the master.
class MasterRegistration {
 public:
  /// @param services full names of the services to register, besides the logger levels' ones
  explicit MasterRegistration(std::vector<std::string> services);

  enum class Master { kSame, kAway, kRestarted };
  /// Asks who the master is; blocks for as long as it takes to answer. Registers all again if it
  /// is another one than the last time.
  Master check();

 private:
  void registerAll() const;

  std::vector<std::string> services_;
  std::optional<int> master_pid_;
};

}  // namespace self_awareness::ros1
