#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ros/verdict/alarm_state.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/stream/waiting.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/ros/graph.h"

namespace self_awareness {

struct MonitorState;
class Session;

/// What the clocks say [ns].
struct Moment {
  std::int64_t ros = 0;
  std::int64_t steady = 0;
  std::int64_t heard_until = 0;  ///< ROS time up to which all was heard
};

/// Why what comes has nothing to do with what was before.
enum class Cut {
  kOtherModel,
  kClockSet,  ///< ROS time was set
};

/// What the monitor is made of besides what hears and what judges. Monitor calls all its parts in
/// one thread, in the order of its list; no part knows another one. What a part cares for, it
/// overrides.
class Part {
 public:
  virtual ~Part() = default;

  /// Offers the part's services, for as long as the servers live. They are called in the same
  /// thread.
  virtual std::vector<ros::ServiceServer> advertise(ros::NodeHandle& /*private_node_handle*/) {
    return {};
  }
  /// A model judges from now on. @param path of its file
  virtual void onStart(const Session& /*session*/, const std::string& /*path*/) {}
  /// What comes has nothing to do with what was before; what was is still of the old model.
  virtual void onCut(Cut /*why*/) {}
  /// Was judged. @param vocabulary that its id is of; it grows until onCut()
  virtual void onEvent(const core::Event& /*event*/, const core::Vocabulary& /*vocabulary*/) {}
  /// How the machine was.
  virtual void onWaiting(const core::Waiting& /*waiting*/) {}
  /// Who talks to whom has changed.
  virtual void onGraph(const ros1::Graph& /*graph*/) {}
  /// A part of a window has passed.
  virtual void onTick(const Moment& /*now*/) {}
  /// A window was judged.
  /// @param verdict as it will be said: a part may explain its suspects
  /// @param circumstances what else is said with it
  virtual void onVerdict(core::Verdict& /*verdict*/, ros1::Circumstances& /*circumstances*/) {}
  /// The level has changed, or an alarm names further components; it was published.
  virtual void onAlarm(const ros1::AlarmState& /*alarm*/) {}
  /// Tells the diagnostics what this part knows.
  virtual void onReport(MonitorState& /*state*/) {}
  /// The program ends: writes what must not be lost. Nothing else is called after it.
  virtual void finish() {}
};

class LiveSource;
class Session;
struct MonitorParameters;

/// The monitor, for parts that ask it for more than they are told.
class Host {
 public:
  /// The model at work; null: there is none.
  virtual Session* session() = 0;
  virtual const MonitorParameters& parameters() const = 0;
  virtual const LiveSource& live() const = 0;
  /// What stands.
  virtual const ros1::AlarmState& alarm() const = 0;
  /// Why nothing is told of a component, in words; empty: it is.
  virtual std::string mutedBy(const std::string& component) const = 0;

  /// Says that what stood is over, although no window brought that about.
  virtual void standDown(const std::string& message) = 0;
  /// Something was unusual, and is over, without an alarm or a suspicion.
  virtual void nearMiss(const core::Alarm& alarm) = 0;
  /// What is heard now is not normal operation. @param why in words
  virtual void notNormal(const std::string& why) = 0;
  /// Has /diagnostics say now how things are.
  virtual void report() = 0;

 protected:
  ~Host() = default;
};

}  // namespace self_awareness
