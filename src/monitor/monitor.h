#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accept_calls.h"
#include "alarm_keeper.h"
#include "blocked_node.h"
#include "flight_recorder.h"
#include "incident_keeper.h"
#include "kept_logs.h"
#include "log_quotes.h"
#include "mute_calls.h"
#include "node/live_source.h"
#include "node/run_node.h"
#include "not_heard.h"
#include "operator_calls.h"
#include "operator_services.h"
#include "parameters.h"
#include "part.h"
#include "reports.h"
#include "restart_watch.h"
#include "ros/verdict/alarm_state.h"
#include "session.h"

namespace self_awareness {

/// Listens to a robot's communication and raises an alarm when it is not what training has seen.
///
/// **Parameters**, all private, are read and checked at the start: one that is out of range ends
/// the node (a nodelet is not loaded), one that is unknown is a warning. docs/monitor.md lists
/// them, config/self_awareness.yaml explains each.
///
/// **Subscribed topics**: those of the model and others by `~subscribe`, of any type.
///
/// **Published topics**
/// - `~status` (self_awareness/SelfAwareness): the verdict on each window.
/// - `~alarm` (self_awareness/SelfAwareness): latched; each change of the level.
/// - `~incidents` (self_awareness/Incidents): latched; the last incidents, whenever one is opened,
///   has grown, or is over.
/// - `~components` (self_awareness/Components): latched, at most once a second; how every node of
///   the graph is, and whether it is watched, for programs.
/// - `/diagnostics` (diagnostic_msgs/DiagnosticArray): one status for the whole, one for every
///   source, one for the monitor itself.
///
/// **Files**: those of the flight recorder; the alarm that stands (AlarmKeeper) and the last
/// incidents (IncidentKeeper): a monitor that is started again goes on with them. MODEL.accepted,
/// beside the model: what is accepted. MODEL.kept: logs of normal operation (KeptLogs).
///
/// **Services**
///
/// ~reset, ~clear and ~reload take an alarm back. Who did so last, and when, is said on
/// /diagnostics. Each is answered five times at once, and then once in 10 s (OperatorCalls).
/// - `~reset` (std_srvs/Trigger): delays, windows and the alarm start from the beginning.
/// - `~clear` (std_srvs/Trigger): ends the alarm and forgets the windows that led to it; delays go
///   on.
/// - `~dump` (std_srvs/Trigger): writes what the flight recorder has; answers with the file's
///   name, without waiting for the disk.
/// - `~reload` (std_srvs/Trigger): reads the parameter `~model` and its file again, and keeps the
///   old model where that fails.
///
/// What somebody mutes goes on ~status, ~alarm and ~incidents as ever, but is OK on /diagnostics,
/// and no more than INFO in the log. The mute has an end, at which the log says what it muted
/// (MuteCalls).
/// - `~mute` (self_awareness/Mute): a component, a topic, a kind, or all is not told for a time.
/// - `~maintenance` (self_awareness/Maintenance): the mute of all.
///
/// What somebody accepts is normal from now on, and kept beside the model (AcceptCalls).
/// - `~accept` (self_awareness/Accept): a new node or topic, or what stands against components, is
///   no evidence any more, until the call is undone or the model is trained with it.
///
/// **Threads**: one thread (LiveSource) serves messages, windows, services and diagnostics through
/// a queue of its own. What may block on the network is done by the thread of Discovery, what
/// waits for the disk by those of FileWriter. They share what has arrived (Arrivals), what the
/// master said (Discovery) and the files to write (FileWriter), each with a lock (Guarded).
class Monitor : public NodeProgram, public LiveSource::Listener, private Host {
 public:
  /// @param name full name of the node or nodelet, for the diagnostics
  /// @throw std::invalid_argument if a parameter is out of range
  Monitor(ros::NodeHandle node_handle, const ros::NodeHandle& private_node_handle,
          const std::string& name);
  ~Monitor() override;

  /// Judges no more, and writes what must not be lost.
  void finish() override;

 private:
  void onEvent(const core::Event& event) override;
  void onContent(core::EventId id, const ros1::Content& content) override;
  void onClockSet(std::int64_t now) override;
  void onPause(std::int64_t pause) override;
  void onWaiting(const core::Waiting& waiting) override;
  void onDropped(const ros1::Publication& publication) override;
  void onGraph(const ros1::Graph& graph) override;
  void onSenders(const core::Senders& senders) override;
  void onMasterRestart(std::int64_t now) override;
  void onTick(std::int64_t now) override;
  void onReport() override { reports_.publish(parts_); }

  Session* session() override { return session_.get(); }
  const MonitorParameters& parameters() const override { return parameters_; }
  const LiveSource& live() const override { return *live_; }
  const ros1::AlarmState& alarm() const override { return alarm_; }
  std::string mutedBy(const std::string& component) const override {
    return mutes_.ofComponent(component);
  }
  void standDown(const std::string& message) override { alarm_.standDown(message, live_->now()); }
  void nearMiss(const core::Alarm& alarm) override { incidents_.addNearMiss(alarm); }
  void notNormal(const std::string& why) override { kept_logs_.leaveOut(why); }
  void report() override { live_->report(); }

  /// Offers the services of all parts. Returns their full names.
  std::vector<std::string> advertise();
  /// Starts with the model of a file; if that fails, all stays as it was.
  /// @throw ros1::ModelFileError if it cannot be read, or its calibration does not fit it
  void load(const std::string& path);
  /// Reads ~model and its file again. Returns why it failed; empty: it did not.
  std::string reload();
  /// What ~accept may refer to; none: there is no model, or the paper's detector judges.
  std::optional<Acceptable> acceptable() const;
  /// Has the model at work judge by what is accepted.
  void onAccepted(const std::string& caller);
  /// Goes on with the incidents, and with an alarm that stood when the monitor ended.
  void resume();
  void restart();
  void onVerdict(const core::Verdict& verdict);
  /// Calls a hook of all parts.
  template <typename Hook, typename... Arguments>
  void all(Hook hook, Arguments&&... arguments) {
    for (Part* part : parts_) {
      (part->*hook)(arguments...);
    }
  }
  ros1::LogSource source() const { return {session_->encoding(), live_->graph()}; }

  ros::CallbackQueue queue_;
  ros::NodeHandle private_node_handle_;
  MonitorParameters parameters_;
  ros::Publisher status_publisher_;
  ros::Publisher alarm_publisher_;
  ros::Publisher incidents_publisher_;
  std::vector<ros::ServiceServer> services_;
  std::unique_ptr<Session> session_;  // none: no model
  ros1::AlarmState alarm_;

  OperatorCalls calls_;
  Reports reports_;
  OperatorServices operators_;
  FlightRecorder recorder_;
  KeptLogs kept_logs_;
  NotHeard not_heard_;
  BlockedNode blocked_;
  LogQuotes quotes_;
  RestartWatch restarts_;
  AlarmKeeper keeper_;
  IncidentKeeper incidents_;
  AcceptCalls accepts_;
  MuteCalls mutes_;
  const std::vector<Part*> parts_;    // mutes last: they take out what others tell
  std::unique_ptr<LiveSource> live_;  // last: its listener uses all of the above
};

}  // namespace self_awareness
