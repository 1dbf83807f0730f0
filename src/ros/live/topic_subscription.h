#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <memory>
#include <string>
#include <vector>

#include "handover.h"
#include "self_awareness/ros/live/arrivals.h"

namespace self_awareness::ros1 {

/// Subscribes to one topic of any type. Where the content of its messages is wanted, it comes
/// through topic_tools::ShapeShifter; else nothing of a message is copied (UnreadMessage).
///
/// Made for a cost below that of a ShapeShifter subscriber (docs/performance.md): roscpp's
/// receiving thread writes down time and connection itself, so that a message does not wake a
/// second thread.
///
/// When the other kind is wanted, a new subscription is made before the old one ends: roscpp keeps
/// the connection, and no message is lost. While there are both, each message reaches first the
/// older one, then the newer one, before the next message comes (Handover).
class TopicSubscription {
 public:
  /// Reads content at first: whether it is wanted is known when the first message has told the
  /// type.
  /// @param arrivals must outlive this
  TopicSubscription(const ros::NodeHandle& node_handle, Arrivals& arrivals,
                    const std::string& topic);
  ~TopicSubscription();
  TopicSubscription(const TopicSubscription&) = delete;
  TopicSubscription& operator=(const TopicSubscription&) = delete;

  /// Changes to the other kind if that is wanted; to be called now and again, since the old
  /// subscription ends with a later call, after a message has come. Does not ask the master: the
  /// topic is subscribed to already.
  void adaptReading();

 private:
  class ImmediateQueue;

  ros::Subscriber subscribe(int number, bool content);
  template <typename Message>
  ros::Subscriber subscribe(int number);

  ros::NodeHandle node_handle_;
  Arrivals& arrivals_;
  const std::shared_ptr<Arrival::Topic> topic_;
  const std::unique_ptr<ImmediateQueue> queue_;
  bool reads_content_ = true;  // the newest subscription
  Handover handover_;
  std::vector<ros::Subscriber> subscribers_;  // the newest last
};

}  // namespace self_awareness::ros1
