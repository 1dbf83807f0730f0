#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/live/live_events.h"
#include "self_awareness/ros/live/master_registration.h"
#include "self_awareness/ros/live/new_publishers.h"
#include "self_awareness/ros/live/own_output.h"

namespace self_awareness {

/// Polls the master in a thread of its own, on steady time, and keeps the subscriptions up to
/// date; notices who begins to publish. All calls that may block on the network are made here.
class Discovery {
 public:
  /// What the subscriptions are chosen by.
  struct Wanted {
    std::set<std::string> model_topics;
    std::shared_ptr<const ros1::Encoder> encoder;  ///< none: nothing is wanted
    ros1::OwnOutput own_output;
  };
  /// What the last poll found.
  struct State {
    bool master_answers = true;  ///< false also while it lets a call wait for long
    std::size_t subscriptions = 0;
    /// Who publishes and subscribes what; none before the master answered, the last while it does
    /// not.
    std::shared_ptr<const ros1::Graph> graph;
  };

  /// @param live_events subscribed to what is chosen; must outlive this
  /// @param interval between polls [s]
  /// @param services full names of services to register again after a restart of the master
  Discovery(ros1::LiveEvents& live_events, ros1::SubscribePolicy policy, double interval,
            std::vector<std::string> services);
  /// Ends the thread; waits for a call to the master that is under way.
  ~Discovery();
  Discovery(const Discovery&) = delete;
  Discovery& operator=(const Discovery&) = delete;

  /// Polls at once with what is wanted from now on, and counts new publishers afresh.
  void setWanted(Wanted wanted);
  /// Polls at once. Publishers that the next poll finds are there from the start.
  void restart();
  /// Polls at once, not only when the interval is over.
  void pollNow();
  State state() const;
  /// Publishers of what is subscribed to that registered after the start and were not taken yet.
  std::vector<ros1::Publisher> takeNewPublishers();

 private:
  void run();
  void poll(const Wanted& wanted, bool restart);

  ros1::LiveEvents& live_events_;
  const ros1::SubscribePolicy policy_;
  const std::chrono::duration<double> interval_;
  ros1::MasterRegistration registration_;  // of the thread
  ros1::NewPublishers publishers_;         // of the thread

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  Wanted wanted_;                                // guarded by mutex_
  State state_;                                  // guarded by mutex_
  std::vector<ros1::Publisher> new_publishers_;  // guarded by mutex_
  // While polling: since when. Guarded by mutex_.
  std::optional<std::chrono::steady_clock::time_point> asked_at_;
  bool poll_now_ = false;  // guarded by mutex_
  bool restart_ = false;   // guarded by mutex_
  bool stopping_ = false;  // guarded by mutex_
  std::thread thread_;     // last: it uses all of the above
};

}  // namespace self_awareness
