#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

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

/// All lists as they are told where nothing is left out.
std::string allLists(const MonitorState& state);

/// Tells how the monitor itself is.
void tellMonitor(const MonitorState& state, diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace self_awareness
