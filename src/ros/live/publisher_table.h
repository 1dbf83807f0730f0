#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "self_awareness/ros/live/arrivals.h"
#include "self_awareness/ros/live/hosts.h"
#include "self_awareness/ros/live/read_limits.h"
#include "self_awareness/ros/live/subscriptions.h"
#include "topic_link.h"
#include "topic_request.h"

struct pollfd;

namespace self_awareness::ros1 {

/// Publishers by the address of their node; which of their topics is connected, and when which is
/// asked for again.
///
/// Belongs to one thread, and never waits. Times are steady [ns].
class PublisherTable {
 public:
  PublisherTable(Arrivals& arrivals, const ReadLimits& limits);
  ~PublisherTable();
  PublisherTable(const PublisherTable&) = delete;
  PublisherTable& operator=(const PublisherTable&) = delete;

  void setListening(const Listening& listening, std::int64_t now);
  /// Notices what was lost, and begins to ask who is due.
  void attend(std::int64_t now);
  /// Goes on with what is asked. To be called when poll() has found one of sockets() ready.
  void advance(std::int64_t now);
  /// Whom poll() has to wait for.
  void sockets(std::vector<pollfd>& sockets) const;
  std::vector<Unheard> unheard(std::int64_t now) const;

 private:
  struct Publication {
    std::string node;
    std::shared_ptr<TopicLink> link;  // none: it is to be asked for
    bool named = true;                // by the master, as it was heard last
    bool first = false;
    int failures = 0;
    std::int64_t missing_since = 0;
    std::int64_t connected_at = 0;  // when the link was made
    std::int64_t try_at = 0;
    std::string why = "has not answered yet";
    bool dead = false;
  };
  struct Node {  // as an address has it
    std::string host;
    int port = 0;
    std::map<std::string, Publication> publications;  // by topic
    std::unique_ptr<TopicRequest> request;            // that is under way
    std::string topic;                                // that it asks for
    std::string data_host;                            // that is looked for, of an answer
    int data_port = 0;
    std::int64_t asked_at = 0;
  };
  struct Due {
    Node* node;
    const std::string* topic;
    Publication* publication;
  };

  Publication& publicationOf(const std::string& topic, const Publisher& publisher,
                             std::int64_t now);
  /// Closes what is not wanted any more.
  void forgetOthers(const Listening& listening);
  void watchLink(Publication& publication, std::int64_t now);
  /// Closes connections to a node that is connected at a new address, unless it still speaks: then
  /// there are two of its name.
  void closeReplaced(const std::set<std::pair<std::string, std::string>>& standing,
                     std::int64_t now);
  void ask(const Due& due, std::int64_t now);
  void advance(Node& node, std::int64_t now);
  void onAnswer(Node& node, std::int64_t now);
  void connect(Node& node, const std::string& ip, std::int64_t now);
  /// An attempt has failed; `all`: whatever is asked of this node will.
  void fail(Node& node, const std::string& why, bool dead, bool all, std::int64_t now);
  static void postpone(Publication& publication, const std::string& why, bool dead,
                       std::int64_t now);

  Arrivals& arrivals_;
  const ReadLimits limits_;
  const std::shared_ptr<std::atomic<std::size_t>> in_flight_;
  Hosts hosts_;
  std::map<std::string, std::weak_ptr<Arrival::Topic>> topics_;
  std::map<std::string, Node> nodes_;  // by URI
  std::size_t size_ = 0;               // publications
  std::size_t left_out_ = 0;           // that are too many
  std::size_t asking_ = 0;
  double tokens_ = 0;  // attempts that may begin now
  std::int64_t counted_at_ = 0;
};

}  // namespace self_awareness::ros1
