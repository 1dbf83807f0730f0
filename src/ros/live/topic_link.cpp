#include "topic_link.h"

#include <ros/connection_manager.h>
#include <ros/console.h>
#include <ros/header.h>
#include <ros/poll_manager.h>
#include <ros/this_node.h>
#include <ros/transport/transport_tcp.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cstring>
#include <utility>

#include "../now.h"
#include "../text.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::uint32_t kPart = 262144;             // bytes that are read at a time
constexpr std::size_t kFirst = 1000000;             // bytes that a message has room for at first
constexpr std::uint32_t kMostMessage = 1000000000;  // as roscpp has it [bytes]
constexpr std::size_t kMostWords = 200;

std::uint32_t numberIn(const boost::shared_array<std::uint8_t>& bytes) {
  std::uint32_t number = 0;  // as little-endian as the machines that ROS runs on
  std::memcpy(&number, bytes.get(), sizeof number);
  return number;
}

std::string inMegabytes(std::uint32_t bytes) {
  return std::to_string(bytes / 1000000) + " MB";
}

}  // namespace

TopicLink::TopicLink(std::shared_ptr<Arrival::Topic> topic, Arrivals& arrivals,
                     const ReadLimits& limits, std::shared_ptr<std::atomic<std::size_t>> in_flight)
    : topic_(std::move(topic)),
      arrivals_(arrivals),
      limits_(limits),
      in_flight_(std::move(in_flight)) {}

TopicLink::~TopicLink() {
  close();
  dropContent();
}

void TopicLink::connect(const std::string& ip, int port) {
  const auto transport =
      boost::make_shared<ros::TransportTCP>(&ros::PollManager::instance()->getPollSet());
  if (!transport->connect(ip, port)) {
    lose("its address cannot be connected to");
    return;
  }
  connection_ = boost::make_shared<ros::Connection>();
  connection_->initialize(transport, false, ros::HeaderReceivedFunc());
  // Before it can be dropped: what was dropped by then would stay in roscpp for good.
  ros::ConnectionManager::instance()->addConnection(connection_);
  connection_->addDropListener([weak = weak_from_this()](const ros::ConnectionPtr& /*connection*/,
                                                         ros::Connection::DropReason /*reason*/) {
    if (const auto link = weak.lock()) {
      link->lose("the connection was closed");
    }
  });
  read(sizeof(std::uint32_t), &TopicLink::onHeaderLength);
  connection_->writeHeader({{"callerid", ros::this_node::getName()},
                            {"topic", topic_->name},
                            {"md5sum", "*"},
                            {"type", "*"},
                            {"tcp_nodelay", "1"}},
                           [](const ros::ConnectionPtr& /*connection*/) {});
}

void TopicLink::close() {
  shared_.lock()->closed = true;
  lost_ = true;
  if (connection_) {
    connection_->drop(ros::Connection::Destructing);
  }
}

std::string TopicLink::why() const {
  return shared_.lock()->why;
}

void TopicLink::read(std::uint32_t size, Step next) {
  connection_->read(size, [weak = weak_from_this(), next](const ros::ConnectionPtr& /*connection*/,
                                                          const Bytes& bytes, std::uint32_t length,
                                                          bool success) {
    const auto link = weak.lock();
    if (link && !success) {
      link->lose("the connection was closed");
    } else if (link && !link->lost_) {
      (*link.*next)(bytes, length);
    }
  });
}

void TopicLink::onHeaderLength(const Bytes& bytes, std::uint32_t /*size*/) {
  const std::uint32_t length = numberIn(bytes);
  if (length > kMostHeader) {
    lose("announces a header of " + inMegabytes(length));
  } else {
    read(length, &TopicLink::onHeader);
  }
}

void TopicLink::onHeader(const Bytes& bytes, std::uint32_t size) {
  ros::Header header;
  std::string error;
  if (!header.parse(bytes, size, error)) {
    lose("its header is none");
  } else if (header.getValue("error", error)) {
    lose("refuses: " + printable(error, kMostWords));
  } else {
    header_ = header.getValues();
    const Connection connection = connectionFrom(*header_, topic_->name);
    attributes_.emplace(connection);
    answered_ = true;
    read(sizeof(std::uint32_t), &TopicLink::onLength);
  }
}

void TopicLink::onLength(const Bytes& bytes, std::uint32_t /*size*/) {
  left_ = numberIn(bytes);
  if (left_ > kMostMessage) {
    lose("announces a message of " + inMegabytes(left_));
    return;
  }
  attributes_->begin(left_);
  if (topic_->content_wanted && left_ <= limits_.message) {
    content_ = std::make_shared<Content>();
  } else if (topic_->content_wanted) {
    ROS_WARN_THROTTLE(10, "%s: a message of %s is not read: more than %zu MB (max_message)",
                      topic_->name.c_str(), inMegabytes(left_).c_str(), limits_.message / 1000000);
  }
  readOn();
}

void TopicLink::readOn() {
  if (left_ > 0) {
    read(std::min(left_, kPart), &TopicLink::onPart);
  } else {
    handOn();
    read(sizeof(std::uint32_t), &TopicLink::onLength);
  }
}

void TopicLink::onPart(const Bytes& bytes, std::uint32_t size) {
  left_ -= size;
  attributes_->add(bytes.get(), size);
  if (content_) {
    *in_flight_ += size;
    if (content_->capacity() <
        content_->size() + size) {  // twice as much, but no more than it needs
      content_->reserve(std::min<std::size_t>(
          content_->size() + size + left_, std::max<std::size_t>(2 * content_->size(), kFirst)));
    }
    content_->insert(content_->end(), bytes.get(), bytes.get() + size);
    if (*in_flight_ > limits_.together) {
      dropContent();
      ROS_WARN_THROTTLE(10, "%s: a message is not read: all together take more than %zu MB",
                        topic_->name.c_str(), limits_.together / 1000000);
    }
  }
  readOn();
}

void TopicLink::handOn() {
  std::shared_ptr<Content> content = content_;
  dropContent();
  const std::int64_t now = rosNow();
  const std::int64_t steady = steadyNow();
  heard_at_ = steady;
  const core::Attributes attributes = attributes_->end(now);
  const auto shared = shared_.lock();
  if (!shared->closed) {
    arrivals_.add({topic_, header_, now, steady, std::move(content), attributes});
  }
}

void TopicLink::dropContent() {
  if (content_) {
    *in_flight_ -= content_->size();
    content_.reset();
  }
}

void TopicLink::lose(const std::string& why) {
  {
    const auto shared = shared_.lock();
    if (shared->why.empty()) {
      shared->why = why;
    }
  }
  if (!lost_.exchange(true)) {
    if (connection_) {
      connection_->drop(ros::Connection::Destructing);
    }
  }
}

}  // namespace self_awareness::ros1
