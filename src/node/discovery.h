#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "ros/live/slave_api.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/guarded.h"
#include "self_awareness/ros/live/arrivals.h"
#include "self_awareness/ros/live/master_registration.h"
#include "self_awareness/ros/live/subscriptions.h"
#include "self_awareness/ros/named_once.h"

namespace self_awareness {

/// Polls the master in a thread of its own, on steady time, and keeps what is listened to as the
/// master says: who publishes where, and what the master knows of this node. All calls that may
/// block on the network are made here.
///
/// What the thread shares with others is in Shared; the rest is the thread's own.
class Discovery {
 public:
  /// Most topics that are subscribed to besides those of the model: each takes memory and files.
  static constexpr std::size_t kMostOthers = 2000;
  /// Nothing else is done meanwhile.
  static constexpr std::chrono::seconds kLongestAsking{3};

  /// What the subscriptions are chosen by.
  struct Wanted {
    std::set<std::string> model_topics;
    std::shared_ptr<const ros1::Encoder> encoder;  ///< none: nothing is wanted
  };
  /// What the last poll found.
  struct State {
    bool master_answers = true;  ///< false also while it lets a call wait for long
    std::size_t subscriptions = 0;
    std::size_t left_out = 0;         ///< topics beyond kMostOthers
    std::size_t master_restarts = 0;  ///< that were noticed
    /// Who publishes and subscribes what; none before the first answer of the master, the last one
    /// while it does not answer.
    std::shared_ptr<const ros1::Graph> graph;
  };

  /// @param arrivals where messages of what is chosen go; must outlive this
  /// @param interval between polls [s]
  /// @param services full names of services to register again after a restart of the master
  Discovery(ros1::Arrivals& arrivals, ros1::SubscribePolicy policy, double interval,
            std::vector<std::string> services);
  /// Ends the thread and the subscriptions; waits for a call that is under way, to the master or a
  /// node.
  ~Discovery();

  /// Polls at once with what is wanted from now on.
  void setWanted(Wanted wanted);
  /// What nodes answered, by name; without those that there was no time for.
  using Answers = std::map<std::string, ros1::Answer>;
  /// Has nodes asked once whether they answer, one after the other, for kLongestAsking in all,
  /// after a poll at once.
  void ask(std::vector<std::string> nodes);
  /// What they answered; none: they are still asked.
  std::optional<Answers> answers() const { return shared_.lock()->answers; }
  State state() const;
  /// Publishers that the master names, and that are not heard.
  std::vector<ros1::Unheard> unheard() const { return subscriptions_.unheard(); }

 private:
  struct Shared {
    Wanted wanted;
    State state;
    /// While the master is asked: since when.
    std::optional<std::chrono::steady_clock::time_point> asked_at;
    std::vector<std::string> to_ask;
    std::optional<Answers> answers;
    bool poll_now = true;
    bool stopping = false;
  };

  void run();
  /// Waits until it is time to poll; none: the thread must end.
  std::optional<Wanted> awaitPoll();
  void poll(const Wanted& wanted);
  /// Asks whom somebody wants asked.
  void askNodes();
  /// Brings what is listened to up to date, and says how much it is, and on which computers it is
  /// sent.
  void listen(const Wanted& wanted, ros1::SystemState& known, bool master_restarted, State& state);
  /// Says which topics are left out, since nobody can subscribe to them.
  void nameIllegal(const Wanted& wanted, const ros1::Graph& graph);

  const ros1::SubscribePolicy policy_;
  const std::chrono::duration<double> interval_;
  ros1::MasterRegistration registration_;
  ros1::Subscriptions subscriptions_;
  ros1::NamedOnce illegal_;
  std::set<std::string> topics_;  // that are subscribed to

  ros1::Guarded<Shared> shared_;
  std::condition_variable wake_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace self_awareness
