#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <ros/steady_timer.h>
#include <std_srvs/Trigger.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "alarm_state.h"
#include "diagnostics.h"
#include "discovery.h"
#include "heard_tally.h"
#include "parameters.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/live/clock_watch.h"
#include "self_awareness/ros/live/live_events.h"
#include "self_awareness/ros/model/model_file.h"
#include "session.h"

namespace self_awareness {

/// Listens to a robot's communication and raises an alarm when it is not what training has seen.
///
/// Subscribes: all topics of the model and others by ~subscribe, of any type.
/// Publishes: ~status (SelfAwareness, one a window), ~alarm (SelfAwareness, latched, on every
/// change
///   of level), /diagnostics.
/// Services (std_srvs/Trigger): ~reset (delays, windows and alarm start afresh), ~clear (the alarm
///   only), ~reload (reads ~model again; keeps the old one where that fails).
/// Parameters: MonitorParameters.
///
/// Threads: messages, windows, services and diagnostics are served by one thread through a queue
/// of its own; what may block on the network is Discovery's. Nothing else is shared.
class Monitor {
 public:
  /// @param name full name of the node or nodelet, for the diagnostics
  /// @throw std::invalid_argument if a parameter is out of range
  Monitor(const ros::NodeHandle& node_handle, const ros::NodeHandle& private_node_handle,
          const std::string& name);
  ~Monitor();
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;

 private:
  void load();
  /// @throw ros1::ModelFileError if the model's calibration does not fit it
  std::unique_ptr<Session> makeSession(ros1::TrainedModel trained);
  void startSession(ros1::TrainedModel trained);

  void onArrivals();
  void onEvent(const core::Event& event);
  void onTick(const ros::SteadyTimerEvent& tick);
  void onVerdict(const core::Verdict& verdict);
  bool onReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onClear(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onReload(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  /// Starts afresh where ROS time was set. Returns the ROS time [ns] that it looked at: by another
  /// look, the clock may have been set again.
  std::int64_t watchClock();
  void restart();
  /// Publishes a change of level that no window brought about.
  void standDown(const std::string& message);
  void publishDiagnostics();
  void refreshGraph(const std::shared_ptr<const ros1::Graph>& graph);

  ros::CallbackQueue queue_;
  ros::NodeHandle node_handle_;
  ros::NodeHandle private_node_handle_;
  MonitorParameters parameters_;
  ros::Publisher status_publisher_;
  ros::Publisher alarm_publisher_;
  std::vector<ros::ServiceServer> services_;
  ros::SteadyTimer timer_;
  Diagnostics diagnostics_;

  std::string model_error_;
  std::unique_ptr<Session> session_;  // none: no model
  ros1::ClockWatch clock_watch_;
  AlarmState alarm_;
  HeardTally heard_;
  std::shared_ptr<const ros1::Graph> graph_;  // the newest that was taken over

  std::unique_ptr<ros1::LiveEvents> live_events_;
  std::unique_ptr<Discovery> discovery_;
  ros::AsyncSpinner spinner_;
};

}  // namespace self_awareness
