#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "self_awareness/ros/guarded.h"
#include "self_awareness/ros/live/arrivals.h"

namespace self_awareness::ros1 {

/// Who publishes a topic, as the master names it.
struct Publisher {
  std::string node;
  std::string uri;  ///< of its XML-RPC server; empty: the master does not know it
};
inline bool operator<(const Publisher& a, const Publisher& b) {
  return std::tie(a.node, a.uri) < std::tie(b.node, b.uri);
}

/// Who is to be listened to.
struct Listening {
  std::map<std::string, std::set<Publisher>> topics;
  std::set<std::string> first;  ///< topics whose publishers are told of before others
};

/// A publisher that the master names, and that is not heard.
struct Unheard {
  std::string node;
  std::string topic;
  std::string why;
  bool dead = false;  ///< its machine says that nobody listens at its address
};

/// Subscriptions of roscpp to topics of any type (topic_tools::ShapeShifter), whose messages go to
/// Arrivals.
///
/// The master tells roscpp once who publishes. What is lost on that way, roscpp never learns: a
/// node that came while its host had no address, or an update that did not arrive. So what the
/// master says is compared with whom this node is connected to, and who is missing is told to
/// roscpp again.
///
/// Threads: listen() and the destructor are for one thread, and wait for the network; unheard()
/// is for any.
class Subscriptions {
 public:
  /// Most that unheard() tells.
  static constexpr std::size_t kMostUnheard = 1000;

  /// @param arrivals must outlive this
  explicit Subscriptions(Arrivals& arrivals);
  ~Subscriptions();

  /// Listens to these topics and to no others. To be called again and again: it also looks who is
  /// missing.
  void listen(const Listening& listening);
  /// Who has been missing for 3 s; those of the first topics before others.
  std::vector<Unheard> unheard() const {
    const auto unheard = unheard_.lock();
    return *unheard;
  }

 private:
  using Publication = std::pair<std::string, Publisher>;  // topic, and who publishes it
  struct Missing {
    std::int64_t since = 0;    // [ns of steady time]
    std::int64_t tell_at = 0;  // when roscpp is told again [ns of steady time]
    std::int64_t pause = 0;    // after that [ns]
    std::string why = "has not answered yet";
  };
  class Queue;
  struct Subscribed {
    std::unique_ptr<Queue> queue;  // first: the subscriber uses it
    ros::Subscriber subscriber;
  };

  void subscribe(const std::string& topic);
  /// Notes who is missing, and since when.
  void compare(const Listening& listening, std::int64_t now);
  /// Tells roscpp again of those who are missing, with longer and longer pauses. If a node is
  /// there and not connected after 3 s, the topic is subscribed to anew.
  void tellAgain(const Listening& listening, std::int64_t now);
  std::vector<Unheard> missingFor3s(const std::set<std::string>& first, std::int64_t now) const;

  Arrivals& arrivals_;
  ros::CallbackQueue large_;  // large messages, that wait to be copied
  ros::AsyncSpinner copying_{1, &large_};
  std::map<std::string, Subscribed> subscribers_;  // by topic
  std::map<Publication, Missing> missing_;
  Guarded<std::vector<Unheard>> unheard_;
};

}  // namespace self_awareness::ros1
