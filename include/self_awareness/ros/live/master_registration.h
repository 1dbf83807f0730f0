#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/ros/graph.h"

namespace self_awareness::ros1 {

/// What the master knows of this process: its topics and services. roscpp registers once; what the
/// master has forgotten since (it was restarted, or somebody has cleaned up) is registered again.
/// Without that no other node finds this one.
class MasterRegistration {
 public:
  /// @param services full names of the services to register, besides the logger levels' ones
  explicit MasterRegistration(std::vector<std::string> services);

  enum class Master { kSame, kAway, kRestarted };
  /// Asks who the master is; blocks for as long as it takes to answer.
  Master check();

  /// Registers what the master does not know.
  /// @return number of registrations that had vanished
  std::size_t keep(const SystemState& state);

 private:
  // Of the services; asked for while roscpp runs: once it ends, it knows its port no more.
  const std::string service_uri_;
  std::vector<std::string> services_;
  std::optional<int> master_pid_;
};

}  // namespace self_awareness::ros1
