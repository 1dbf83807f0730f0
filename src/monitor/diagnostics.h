#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <cstddef>
#include <string>
#include <vector>

#include "ros/verdict/heard_tally.h"
#include "self_awareness/SelfAwareness.h"

namespace self_awareness {

/// What the diagnostics tell; filled in by the monitor, worded by Diagnostics.
struct MonitorState {
  std::string model;        ///< path
  std::string model_error;  ///< why there is none; empty: it is loaded
  bool calibrated = false;
  bool started = false;                ///< something was said of a window
  self_awareness::SelfAwareness last;  ///< the verdict on the last window, if started
  bool busy = false;                   ///< the machine is to blame, no component
  double level_for = 0;                ///< how long it has had its level [s]
  ros1::HeardReport heard;
  std::size_t subscriptions = 0;
  std::size_t connections = 0;
  bool master_answers = true;
};

/// Publishes on /diagnostics (REP-107: OK, WARN, ERROR; never STALE): one status for the whole,
/// one for every component, one for the monitor itself.
class Diagnostics {
 public:
  /// @param name of the monitor, which the statuses' names begin with
  /// @param component_statuses whether every component has a status of its own
  Diagnostics(const ros::NodeHandle& node_handle, const ros::NodeHandle& private_node_handle,
              const std::string& name, const std::string& hardware_id, bool component_statuses);

  /// Publishes the state now.
  void publish(const MonitorState& state);
  /// Time between heartbeats [s]: ~diagnostic_period, 1 by default.
  double period() { return updater_.getPeriod(); }

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  void updateComponents();
  void communication(Status& status) const;
  void component(const std::string& name, Status& status) const;
  void monitor(Status& status) const;

  bool component_statuses_;
  MonitorState state_;
  std::vector<std::string> components_;  // that have a status
  diagnostic_updater::Updater updater_;
};

}  // namespace self_awareness
