#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/SelfAwareness.h"

namespace self_awareness::ros1 {

/// "SOURCE on SCOPE: REASON", without the source where the encoding leaves it out.
std::string describe(const self_awareness::Suspect& suspect);

/// What the diagnostics tell; filled in by the monitor, worded by Diagnostics.
struct MonitorState {
  struct Component {
    std::optional<double> last_heard;  ///< seconds ago; none: not since the start
    double rate = 0;                   ///< events a second, since the last report
  };

  std::string model;        ///< path
  std::string model_error;  ///< why there is none; empty: it is loaded
  bool calibrated = false;
  bool started = false;                         ///< an event has come
  self_awareness::SelfAwareness last;           ///< the verdict on the last window, if started
  double level_for = 0;                         ///< how long it has had its level [s]
  std::map<std::string, Component> components;  ///< by core::componentOf()

  double rate = 0;              ///< events a second, since the last report
  double processing_share = 0;  ///< share of one core spent on events and windows, 0 to 1
  std::size_t subscriptions = 0;
  std::size_t connections = 0;
  std::uint64_t dropped = 0;        ///< messages, since the start
  std::uint64_t newly_dropped = 0;  ///< messages, since the last report
  std::uint64_t clock_steps = 0;    ///< since the start
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

}  // namespace self_awareness::ros1
