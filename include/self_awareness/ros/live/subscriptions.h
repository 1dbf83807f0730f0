#pragma once

#include <ros/node_handle.h>

#include <map>
#include <memory>
#include <set>
#include <string>

#include "self_awareness/ros/graph.h"
#include "self_awareness/ros/live/arrivals.h"
#include "self_awareness/ros/live/named_once.h"

namespace self_awareness::ros1 {

class TopicSubscription;

/// The subscriptions to topics of any type, whose messages go to Arrivals.
///
/// Belongs to one thread, which may be another one than that of LiveEvents: setTopics() asks the
/// master, and blocks for as long as the master takes to answer.
class Subscriptions {
 public:
  /// @param arrivals must outlive this
  Subscriptions(const ros::NodeHandle& node_handle, Arrivals& arrivals);
  /// Nothing arrives any more.
  ~Subscriptions();
  Subscriptions(const Subscriptions&) = delete;
  Subscriptions& operator=(const Subscriptions&) = delete;

  /// Subscribes to these topics and to no others. Where the type of a topic changed, subscribes
  /// again: roscpp holds on to the first type that it met.
  void setTopics(const std::set<std::string>& topics, const Graph& graph);

  /// Has the content of messages read where it is wanted now (Arrival::Topic::content_wanted), and
  /// nowhere else. Does not ask the master.
  void adaptReading();

  /// Lets the next setTopics() subscribe to these topics again: roscpp connects to their
  /// publishers anew. Does ask the master.
  void renew(const std::set<std::string>& topics);

 private:
  struct Subscription {
    std::unique_ptr<TopicSubscription> subscription;
    std::string datatype;
  };

  ros::NodeHandle node_handle_;
  Arrivals& arrivals_;
  std::map<std::string, Subscription> subscriptions_;
  NamedOnce changed_;  // topics whose type did
};

}  // namespace self_awareness::ros1
