#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/steady_timer.h>

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "clock_contest.h"
#include "discovery.h"
#include "processor_watch.h"
#include "self_awareness/core/stream/clock_watch.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/waiting.h"
#include "self_awareness/core/stream/windows.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/live/live_events.h"
#include "self_awareness/ros/own_output.h"

namespace self_awareness {

/// Parameters that all who listen have; the comment of Monitor explains them.
struct LiveParameters {
  ros1::SubscribePolicy subscribe = ros1::SubscribePolicy::kUsed;  ///< ~subscribe
  double poll_interval = 1.0;       ///< ~poll_interval: of the master [s]
  std::uint32_t queue_size = 1000;  ///< ~queue_size: messages a connection may have waiting
  double diagnostic_period = 1.0;   ///< ~diagnostic_period: between two reports [s]
};

/// Messages that came before a window's end may wait for this long when it is closed [ns].
constexpr std::int64_t kGrace = 20000000;

/// The robot's communication as it happens, for one listener: subscribes to what Discovery finds,
/// turns it into events, watches the clock, and ticks.
///
/// Threads: one serves the queue from start() to stop(), and calls the listener. Other functions
/// are for this thread, or for while it does not run.
class LiveSource {
 public:
  class Listener {
   public:
    /// Was received, and not before ROS time was set last.
    virtual void onEvent(const core::Event& event) = 0;
    /// The content of a message that was read for its event type, before the event.
    virtual void onContent(core::EventId /*id*/, const ros1::Content& /*content*/) {}
    /// ROS time was set; events that come from now on were received after that.
    /// @param now ROS time [ns]
    virtual void onClockSet(std::int64_t now) = 0;
    /// It is time to deliver(), and to do what follows from it. @param now ROS time [ns]
    virtual void onTick(std::int64_t now) = 0;
    /// It is time to report, after each period of steady time or by report().
    virtual void onReport() = 0;
    /// This program stood still: what came meanwhile was received late, or never. onWaiting()
    /// follows, before what was received.
    /// @param pause [ns of steady time]
    virtual void onPause(std::int64_t /*pause*/) {}
    /// How the machine was in the stretch of time after the one before.
    virtual void onWaiting(const core::Waiting& /*waiting*/) {}
    /// Messages of this publisher were dropped.
    virtual void onDropped(const ros1::Publication& /*publication*/) {}
    /// Who sends now, as far as events do not say it.
    virtual void onSenders(const core::Senders& /*senders*/) {}
    /// Who talks to whom has changed, or is known for the first time with what is wanted.
    virtual void onGraph(const ros1::Graph& /*graph*/) {}
    /// The master, and thus the robot, was started again. @param now ROS time [ns]
    virtual void onMasterRestart(std::int64_t /*now*/) {}

   protected:
    ~Listener() = default;
  };

  /// What is listened to, and how.
  struct Wanted {
    std::shared_ptr<const ros1::Encoder> encoder;
    std::set<std::string> model_topics;          ///< besides those by the policy
    ros1::OwnOutput own_output;                  ///< left out
    std::int64_t window = core::kDefaultWindow;  ///< length: at its end events wait no longer [ns]
    std::int64_t hold = 0;  ///< how long what may yet be left out is kept back [ns of steady time]
    ros::WallDuration tick{0.025};  ///< between two ticks, also before setWanted()
  };

  /// @param queue that of the node handle; must outlive this, as the listener must
  /// @param services full names of services that this queue serves
  LiveSource(ros::CallbackQueue& queue, const ros::NodeHandle& node_handle,
             const LiveParameters& parameters, std::vector<std::string> services,
             Listener& listener);

  void start() { spinner_.start(); }
  /// The listener is not called any more, but by deliver() and report().
  void stop() { spinner_.stop(); }
  /// Until the first call there are no events, but ticks.
  void setWanted(Wanted wanted);
  /// Turns what has arrived into events.
  void deliver() { live_events_.deliver(); }
  /// Has nodes asked, as Discovery::ask().
  void ask(std::vector<std::string> nodes) { discovery_.ask(std::move(nodes)); }
  /// Has the listener report now; the next time is a period later.
  void report();

  /// Who talks to whom; none: not known yet, since what is wanted was set.
  const std::shared_ptr<const ros1::Graph>& graph() const { return graph_; }
  const core::ClockWatch& clock() const { return clock_watch_; }
  /// ROS time, or what counts in its place while several nodes set it [ns].
  std::int64_t now() const;
  /// Who publishes /clock, if several do; else empty.
  std::string clockRivals() const;
  const ros1::LiveEvents& events() const { return live_events_; }
  const Discovery& discovery() const { return discovery_; }

 private:
  ros1::LiveEvents::Handlers handlers();
  void onTick(const ros::SteadyTimerEvent& tick);
  /// Tells how the machine was up to now [ns], if there is something to tell.
  void tellWaiting(std::int64_t now);
  /// Tells if ROS time was set, or this program stood still. Returns the ROS time [ns] that it
  /// looked at: by another look, the clock may have been set again.
  std::int64_t watchClock();

  Listener& listener_;
  const double period_;       // between two reports [s]
  std::int64_t reported_at_;  // steady time [ns]
  ros::WallDuration tick_ = Wanted().tick;
  ros::SteadyTimer timer_;
  ClockContest contest_;
  core::ClockWatch clock_watch_;
  ProcessorWatch processor_watch_;
  std::shared_ptr<const ros1::Encoder> encoder_;  // none: nothing is wanted yet
  std::shared_ptr<const ros1::Graph> graph_;      // the newest that was taken over
  std::size_t master_restarts_ = 0;               // that were told

  ros1::LiveEvents live_events_;
  Discovery discovery_;
  ros::AsyncSpinner spinner_;  // last: what it serves uses all of the above
};

}  // namespace self_awareness
