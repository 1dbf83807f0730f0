#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "self_awareness/ros/live/arrivals.h"
#include "self_awareness/ros/live/guarded.h"
#include "self_awareness/ros/live/read_limits.h"

namespace self_awareness::ros1 {

class PublisherTable;

/// Who publishes a topic, as the master names it.
struct Publisher {
  std::string node;
  std::string uri;  ///< of its XML-RPC server; empty: the master does not know it
};
inline bool operator<(const Publisher& a, const Publisher& b) {
  return std::tie(a.node, a.uri) < std::tie(b.node, b.uri);
}
inline bool operator==(const Publisher& a, const Publisher& b) {
  return std::tie(a.node, a.uri) == std::tie(b.node, b.uri);
}

/// Who is to be listened to.
struct Listening {
  std::map<std::string, std::set<Publisher>> topics;
  std::set<std::string> first;  ///< topics whose publishers are asked before others
};

/// A publisher that the master names, and that is not heard.
struct Unheard {
  std::string node;
  std::string topic;
  std::string why;
  bool dead = false;  ///< its machine says that nobody listens at its address
};

/// Connections to all publishers of some topics, whose messages go to Arrivals. Who cannot be
/// connected to is asked again, with longer and longer pauses, in a thread of its own: nobody
/// waits for a host that does not answer, or has no address.
///
/// What somebody tells this node's slave API changes nothing here.
class Subscriptions {
 public:
  /// Publishers of topics that are kept in mind; each takes memory, and a file if it is connected.
  static constexpr std::size_t kMost = 20000;
  /// Most that unheard() tells of the first topics, and of the others.
  static constexpr std::size_t kMostUnheard = 1000;

  /// @param arrivals must outlive this
  explicit Subscriptions(Arrivals& arrivals, const ReadLimits& limits = {});
  /// Nothing arrives any more.
  ~Subscriptions();
  Subscriptions(const Subscriptions&) = delete;
  Subscriptions& operator=(const Subscriptions&) = delete;

  /// Listens to these and to no others. A connection that stands is kept as long as its topic is
  /// listened to, whatever the master says: it is the publisher who closes it.
  void listen(Listening listening);
  /// Who has not been heard for 2 s or more; those of the first topics before others.
  std::vector<Unheard> unheard() const { return shared_.lock()->unheard; }

 private:
  struct Shared {
    std::shared_ptr<const Listening> listening;  // none: nothing new
    std::vector<Unheard> unheard;
    bool stopping = false;
  };

  void run();
  void wake() const;

  const int wake_;                         // an eventfd
  std::unique_ptr<PublisherTable> table_;  // the thread's own
  Guarded<Shared> shared_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace self_awareness::ros1
