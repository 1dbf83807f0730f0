#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flight_recorder.h"
#include "kept_logs.h"
#include "ros/verdict/diagnostic_status.h"
#include "self_awareness/ros/live/subscriptions.h"

namespace self_awareness {

/// What the diagnostics tell; filled in by Reports and the parts of the monitor.
struct MonitorState {
  ros1::CommunicationState communication;
  std::size_t subscriptions = 0;
  std::size_t connections = 0;
  std::size_t left_out_topics = 0;  ///< there were too many
  std::string mode;                 ///< of the robot, in words; empty: nobody tells it
  bool full_of_unknown = false;     ///< further unknown event types are not told apart
  bool master_answers = true;
  std::vector<ros1::Unheard> unheard;       ///< publishers that the master names
  std::int64_t ros_now = 0;                 ///< [ns]
  std::int64_t clock_stands_still_for = 0;  ///< [ns of steady time]
  std::string clock_rivals;                 ///< who publishes /clock, if several do
  std::string taken_back;                   ///< who took an alarm back last; empty: nobody
  std::vector<std::string> mutes;           ///< in words
  std::string accept_error;                 ///< why what is accepted is not in its file
  std::string keeper_error;                 ///< why alarm or incidents are not in their files
  double longest_pause = 0;  ///< for which this program stood still, since the last report [s]
  std::optional<FlightRecorder::Report> recorder;  ///< none: there is no recorder
  std::optional<KeptLogs::Report> kept_logs;       ///< none: nothing is kept to learn from
};

/// Publishes on /diagnostics (REP-107: OK, WARN, ERROR; never STALE): one status for the whole,
/// one for every component, one for the monitor itself.
class Diagnostics {
 public:
  /// @param name of the monitor, which the statuses' names begin with
  /// @param component_statuses whether every component has a status of its own
  /// @param bytes_per_second of all statuses: beyond it, components that do not change are said
  /// one after the other
  Diagnostics(ros::NodeHandle node_handle, const std::string& name, const std::string& hardware_id,
              bool component_statuses, std::size_t bytes_per_second);

  /// Publishes the state now. @param state which lists are told is decided here
  void publish(MonitorState state);

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  static void tellMonitor(const MonitorState& state, Status& status);
  static void tellRecorder(const FlightRecorder::Report& report, Status& status);
  static void tellKeptLogs(const KeptLogs::Report& report, Status& status);

  std::string name_;
  std::string hardware_id_;
  bool component_statuses_;
  ros1::StatusRound round_;
  ros1::ListRound lists_;
  std::int64_t published_at_;  // [ns of steady time]
  ros::Publisher publisher_;
};

}  // namespace self_awareness
