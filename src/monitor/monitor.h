#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <ros/steady_timer.h>
#include <std_srvs/Trigger.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics.h"
#include "discovery.h"
#include "parameters.h"
#include "self_awareness/SelfAwareness.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/ros/live/clock_watch.h"
#include "self_awareness/ros/live/live_events.h"
#include "self_awareness/ros/model/model_file.h"

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
  /// What belongs to one loaded model.
  struct Session {
    /// @throw std::invalid_argument if the calibration does not fit the model
    Session(ros1::TrainedModel trained, const MonitorParameters& parameters,
            core::Detector::Handler handler);

    core::EventId intern(const core::EventType& type);
    std::unique_ptr<core::Judge> makeJudge(const MonitorParameters& parameters) const;

    ros1::TrainedModel trained;
    bool calibrated;
    std::shared_ptr<core::SourceGraph> graph;  // of training, and what the master adds
    core::Vocabulary vocabulary;  // of the model, followed by unknown event types as they appear
    std::shared_ptr<const ros1::Encoder> encoder;
    core::Detector detector;
  };
  struct Heard {
    std::optional<std::int64_t> last;  // [ns]
    std::uint64_t events = 0;          // since the last report
  };

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
  ros1::Diagnostics diagnostics_;

  std::string model_error_;
  std::unique_ptr<Session> session_;  // none: no model
  ros1::ClockWatch clock_watch_;
  self_awareness::SelfAwareness last_;             // verdict on the last window
  std::vector<self_awareness::Suspect> suspects_;  // of the standing alarm
  std::int64_t level_since_ = 0;                   // when the level last changed [ns]
  std::shared_ptr<const ros1::Graph> graph_;       // the newest that was taken over
  std::map<std::string, Heard> components_;        // of the model
  std::vector<Heard*> component_of_;               // by event id of the model
  std::uint64_t events_ = 0;                       // since the last report
  std::uint64_t clock_steps_ = 0;
  std::uint64_t reported_drops_ = 0;
  ros::SteadyTime last_report_;
  ros::WallDuration processing_;  // since the last report

  std::unique_ptr<ros1::LiveEvents> live_events_;
  std::unique_ptr<Discovery> discovery_;
  ros::AsyncSpinner spinner_;
};

}  // namespace self_awareness
