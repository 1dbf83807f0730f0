#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flight_recorder.h"
#include "ros/verdict/diagnostic_status.h"

namespace self_awareness {

/// What the diagnostics tell; filled in by the monitor.
struct MonitorState {
  ros1::CommunicationState communication;
  std::size_t subscriptions = 0;
  std::size_t connections = 0;
  bool master_answers = true;
  std::optional<FlightRecorder::Report> recorder;  ///< none: there is no recorder
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
  void monitor(Status& status) const;
  static void recorder(const FlightRecorder::Report& report, Status& status);

  bool component_statuses_;
  MonitorState state_;
  std::vector<std::string> components_;  // that have a status
  diagnostic_updater::Updater updater_;
};

}  // namespace self_awareness
