#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace self_awareness::core {

/// Says whose messages reach whom, and on which topic (docs/method.md, section 6): it has an edge
/// from every source that publishes on a topic to every source that subscribes to it. It also says
/// on which computer a source runs, what sources publish that nobody hears, and to what they
/// always subscribe, as far as that is known.
class SourceGraph {
 public:
  /// Messages of one source reach another on a topic.
  struct Edge {
    std::string publisher;   ///< name of the source
    std::string topic;       ///< name of the scope
    std::string subscriber;  ///< name of the source that hears it
  };

  /// What a source publishes: its name, and that of the scope.
  using Publication = std::pair<std::string, std::string>;

  /// Adds an edge; one that is there already changes nothing.
  void connect(const std::string& publisher, const std::string& topic,
               const std::string& subscriber);

  /// Says on which computer a source runs: its name or its address. What was said before is
  /// forgotten; empty: it is not known, since the source runs on several, say.
  void place(const std::string& source, const std::string& host) { hosts_[source] = host; }
  /// Computers by source; those that are known, or empty.
  const std::map<std::string, std::string>& hosts() const { return hosts_; }
  /// The computer that a source runs on; empty: it is not known.
  const std::string& hostOf(const std::string& source) const;

  /// Says that nobody of the robot subscribed to what a source publishes.
  void addUnheard(const Publication& publication) { unheard_.insert(publication); }
  /// All of which that was said.
  const std::set<Publication>& unheard() const { return unheard_; }

  /// A source that subscribes, and the scope.
  using Subscription = std::pair<std::string, std::string>;
  /// Says that a subscription lasted, from when the start had had its time to the end, in so many
  /// further recordings.
  void addLasting(const Subscription& subscription, std::size_t recordings = 1) {
    lasting_[subscription] += recordings;
  }
  /// In how many recordings each did.
  const std::map<Subscription, std::size_t>& lasting() const { return lasting_; }

  /// Whether it says nothing: who hears whom is not known.
  bool empty() const { return edges_.empty(); }
  /// All edges, each once.
  const std::set<Edge>& edges() const { return edges_; }
  /// Whether `subscriber` subscribes to a topic on which `publisher` publishes.
  bool hears(const std::string& subscriber, const std::string& publisher,
             const std::string& topic) const {
    return edges_.count({publisher, topic, subscriber}) > 0;
  }
  /// Whether messages of one source reach another one, directly or through others, in fewer steps
  /// than the other way round. Robots have loops; what is wrong with both more likely began there.
  /// @param sources each once
  /// @return by the place of the one, then of the other
  std::vector<std::vector<bool>> upstream(const std::vector<std::string>& sources) const;

 private:
  std::set<Edge> edges_;
  std::map<std::string, std::set<std::string>> followers_;  // of the edges, by publisher
  std::map<std::string, std::string> hosts_;                // by source
  std::set<Publication> unheard_;
  std::map<Subscription, std::size_t> lasting_;
};

inline bool operator<(const SourceGraph::Edge& a, const SourceGraph::Edge& b) {
  return std::tie(a.publisher, a.topic, a.subscriber) <
         std::tie(b.publisher, b.topic, b.subscriber);
}
inline bool operator==(const SourceGraph::Edge& a, const SourceGraph::Edge& b) {
  return std::tie(a.publisher, a.topic, a.subscriber) ==
         std::tie(b.publisher, b.topic, b.subscriber);
}

}  // namespace self_awareness::core
