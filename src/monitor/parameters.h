#pragma once

#include <ros/node_handle.h>

#include <cstddef>
#include <string>
#include <vector>

#include "flight_recorder.h"
#include "kept_logs.h"
#include "node/live_source.h"
#include "ros/verdict/diagnostic_status.h"
#include "self_awareness/core/verdict/detector.h"

namespace self_awareness {

/// All parameters of the monitor; config/self_awareness.yaml explains each to its user.
struct MonitorParameters {
  enum class Method { kEvidence, kPaper };

  std::string model;                    ///< ~model: path of the model file
  Method method = Method::kEvidence;    ///< ~detector
  core::Detector::Parameters detector;  ///< ~settle_time, ~alarm_windows, ~alarm_of,
                                        ///< ~hold_time, ~silence, ~unknown
  std::vector<std::string> optional;    ///< ~optional: patterns of whose absence is accepted
  LiveParameters live;
  bool source_diagnostics = true;               ///< ~source_diagnostics: one status per source
  std::size_t diagnostic_bytes = 2000;          ///< ~diagnostic_bytes: a second, on /diagnostics
  std::string hardware_id = ros1::kNoHardware;  ///< ~hardware_id: of the diagnostics
  RecorderParameters recorder;                  ///< ~recorder/...
  KeptLogsParameters kept_logs;                 ///< ~learn_more, ~learn_more_disk
  std::string run_id;                           ///< /run_id: of the roscore; empty: not known

  /// Reads the parameters, checks and logs them; warns of those it does not know.
  /// @throw std::invalid_argument names the parameter, its value and what it may be
  static MonitorParameters load(const ros::NodeHandle& private_node_handle);
  /// Reads ~model again, and logs it; `otherwise` if it is not set (any more). Blocks if the
  /// master hangs.
  /// @throw std::invalid_argument if it is no text
  static std::string loadModel(const ros::NodeHandle& private_node_handle,
                               const std::string& otherwise);
};

}  // namespace self_awareness
