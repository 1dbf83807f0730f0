#include "self_awareness/ros/live/arrivals.h"

#include <ros/subscribe_options.h>
#include <ros/subscription_callback_helper.h>

#include <boost/make_shared.hpp>
#include <typeinfo>
#include <utility>

#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/windows.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::int64_t kDefaultInterval = core::kNanosecondsPerSecond / 10;

/// In place of a message that is not read.
struct Unread {};

const ros::VoidConstPtr& unread() {
  static const ros::VoidConstPtr kUnread = boost::make_shared<const Unread>();
  return kUnread;
}

}  // namespace

/// Calls back at once, in the thread that received the message. That holds a mutex of the
/// subscription: two messages of a topic never come at the same time, and none after its end.
class Arrivals::ImmediateQueue : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t /*owner*/) override {
    callback->call();
  }
  void removeByID(std::uint64_t /*owner*/) override {}
};

/// What roscpp calls with a message of one topic. It calls this interface one that may change; ROS
/// 1 has come to its last version with it.
class Arrivals::Helper : public ros::SubscriptionCallbackHelper {
 public:
  Helper(Arrivals& arrivals, std::shared_ptr<Arrival::Topic> topic)
      : arrivals_(arrivals), topic_(std::move(topic)) {}

  ros::VoidConstPtr deserialize(
      const ros::SubscriptionCallbackHelperDeserializeParams& params) override {
    if (!topic_->reads) {
      return unread();
    }
    return boost::make_shared<const Arrival::Content>(params.buffer,
                                                      params.buffer + params.length);
  }

  void call(ros::SubscriptionCallbackHelperCallParams& params) override {
    const ros::MessageEvent<void const>& event = params.event;
    Arrival arrival;
    arrival.topic = topic_;
    arrival.header = event.getConnectionHeaderPtr();
    arrival.stamp = static_cast<std::int64_t>(event.getReceiptTime().toNSec());
    if (event.getConstMessage() != unread()) {
      arrival.content =
          boost::static_pointer_cast<const Arrival::Content>(event.getConstMessage());
    }
    arrivals_.add(std::move(arrival));
  }

  /// Subscribers of one process whose types are the same share what one of them deserialized.
  const std::type_info& getTypeInfo() override {
    return topic_->reads ? typeid(Arrival::Content) : typeid(Unread);
  }
  bool isConst() override { return true; }
  bool hasHeader() override { return false; }

 private:
  Arrivals& arrivals_;
  const std::shared_ptr<Arrival::Topic> topic_;
};

Arrivals::Arrivals(std::uint32_t queue_size, std::function<void()> wake)
    : queue_size_(queue_size),
      wake_(std::move(wake)),
      immediate_queue_(std::make_unique<ImmediateQueue>()),
      interval_(kDefaultInterval) {}

Arrivals::~Arrivals() = default;

ros::Subscriber Arrivals::subscribe(ros::NodeHandle& node_handle, const std::string& topic) {
  const auto heard = std::make_shared<Arrival::Topic>();
  heard->name = topic;
  ros::SubscribeOptions options;
  options.topic = topic;
  options.queue_size = 1;
  options.md5sum = "*";
  options.datatype = "*";
  options.helper = boost::make_shared<Helper>(*this, heard);
  options.callback_queue = immediate_queue_.get();
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return node_handle.subscribe(options);
}

void Arrivals::setInterval(std::int64_t interval) {
  const std::lock_guard<std::mutex> lock(mutex_);
  interval_ = interval;
}

void Arrivals::take(std::vector<Arrival>& arrivals) {
  arrivals.clear();
  const std::lock_guard<std::mutex> lock(mutex_);
  arrivals.swap(waiting_);
  for (const Arrival& arrival : arrivals) {
    arrival.topic->waiting = 0;
  }
}

std::uint64_t Arrivals::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

void Arrivals::add(Arrival arrival) {
  bool wake = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (arrival.topic->waiting >= queue_size_) {
      ++dropped_;
      return;
    }
    // Half: there is room for what comes until it is taken.
    wake = ++arrival.topic->waiting == queue_size_ / 2 + 1;
    const std::int64_t interval = core::floorToGrid(arrival.stamp, interval_);
    wake = wake || interval != this_interval_;
    this_interval_ = interval;
    waiting_.push_back(std::move(arrival));
  }
  if (wake) {
    wake_();
  }
}

}  // namespace self_awareness::ros1
