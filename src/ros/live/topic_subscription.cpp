#include "topic_subscription.h"

#include <ros/message_event.h>
#include <ros/subscribe_options.h>
#include <topic_tools/shape_shifter.h>

#include <cstdint>
#include <iterator>

#include "unread_message.h"

namespace self_awareness::ros1 {
namespace {

using Content = boost::shared_ptr<const topic_tools::ShapeShifter>;

Content contentOf(const ros::MessageEvent<const topic_tools::ShapeShifter>& event) {
  return event.getConstMessage();
}

Content contentOf(const ros::MessageEvent<const UnreadMessage>& /*event*/) {
  return nullptr;
}

}  // namespace

/// Calls back at once, in the thread that received the message. That thread holds a mutex of the
/// topic: two messages never come at the same time, and none after the end of a subscription.
class TopicSubscription::ImmediateQueue : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t /*owner*/) override {
    callback->call();
  }
  void removeByID(std::uint64_t /*owner*/) override {}
};

TopicSubscription::TopicSubscription(const ros::NodeHandle& node_handle, Arrivals& arrivals,
                                     const std::string& topic)
    : node_handle_(node_handle),
      arrivals_(arrivals),
      topic_(std::make_shared<Arrival::Topic>(topic)),
      queue_(std::make_unique<ImmediateQueue>()),
      subscribers_{subscribe(0, reads_content_)} {}

TopicSubscription::~TopicSubscription() = default;

void TopicSubscription::adaptReading() {
  if (handover_.complete()) {
    subscribers_.erase(subscribers_.begin(), std::prev(subscribers_.end()));
  }
  const bool wanted = topic_->content_wanted;
  if (wanted != reads_content_) {
    reads_content_ = wanted;
    subscribers_.push_back(subscribe(handover_.newest() + 1, wanted));
    handover_.ready();
  }
}

ros::Subscriber TopicSubscription::subscribe(int number, bool content) {
  return content ? subscribe<topic_tools::ShapeShifter>(number) : subscribe<UnreadMessage>(number);
}

template <typename Message>
ros::Subscriber TopicSubscription::subscribe(int number) {
  using Event = ros::MessageEvent<const Message>;
  ros::SubscribeOptions options;
  options.template initByFullCallbackType<const Event&>(
      topic_->name, 1, [this, number](const Event& event) {
        if (handover_.counts(number)) {
          arrivals_.add({topic_, event.getConnectionHeaderPtr(),
                         static_cast<std::int64_t>(event.getReceiptTime().toNSec()),
                         contentOf(event)});
        }
      });
  options.callback_queue = queue_.get();
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return node_handle_.subscribe(options);
}

}  // namespace self_awareness::ros1
