#include "self_awareness/ros/live/live_events.h"

#include <ros/console.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <stdexcept>
#include <utility>

#include "../text.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {

/// Has the thread that serves the callback queue take what has arrived.
class LiveEvents::Wake : public ros::CallbackInterface {
 public:
  explicit Wake(std::function<void()> on_arrivals) : on_arrivals_(std::move(on_arrivals)) {}
  CallResult call() override {
    on_arrivals_();
    return Success;
  }

 private:
  const std::function<void()> on_arrivals_;
};

LiveEvents::LiveEvents(const ros::NodeHandle& node_handle, std::uint32_t queue_size,
                       Handlers handlers)
    : node_handle_(node_handle),
      handlers_(std::move(handlers)),
      wake_(boost::make_shared<Wake>(handlers_.on_arrivals)),
      arrivals_(queue_size,
                [this] { node_handle_.getCallbackQueue()->addCallback(wake_, wakeId()); }),
      senders_([this](std::int64_t /*now*/, const core::Senders& senders) {
        handlers_.on_senders(senders);
      }) {}

LiveEvents::~LiveEvents() {
  node_handle_.getCallbackQueue()->removeByID(wakeId());
}

void LiveEvents::setEncoder(std::shared_ptr<const Encoder> encoder, OwnOutput own_output,
                            std::int64_t window, std::int64_t hold) {
  encoder_ = std::move(encoder);
  own_output_ = std::move(own_output);
  hold_ = hold;
  arrivals_.setInterval(window);
  for (auto& [key, live] : connections_) {
    live.held.clear();  // ids of another encoder
    live.held_until.reset();
  }
  senders_.restart();
  encodeAgain();
  lasting_again_ = true;
}

void LiveEvents::setGraph(const Graph& graph) {
  if (own_output_.setGraph(graph) && encoder_) {
    encodeAgain();
    lasting_again_ = true;
  }
}

void LiveEvents::encodeAgain() {
  for (auto& [key, live] : connections_) {
    const Connection connection = connectionFrom(*live.header, *live.topic);
    live.encoder = connect(connection);
    live.link = senders_.connect(connection, *encoder_);
    if (live.encoder) {
      live.latched = !live.encoder->accept();  // the first message came before
    } else {
      live.held.clear();
    }
  }
}

void LiveEvents::forgetClosedConnections() {
  for (auto connection = connections_.begin(); connection != connections_.end();) {
    const LiveConnection& live = connection->second;
    const bool closed = live.header.use_count() == 1 && live.held.empty();
    connection = closed ? connections_.erase(connection) : std::next(connection);
  }
}

std::size_t LiveEvents::connections() const {
  return static_cast<std::size_t>(
      std::count_if(connections_.begin(), connections_.end(),
                    [](const auto& connection) { return connection.second.encoder.has_value(); }));
}

void LiveEvents::tellLastingAgain() {
  LiveConnection* last = nullptr;
  for (auto& [key, live] : connections_) {
    if (live.latched && live.encoder) {
      tellLatched(live, now(), steadyNow());
    }
    const bool tells = live.mode && live.encoder && live.encoder->tellsMode();
    if (tells && (last == nullptr || live.mode_told > last->mode_told)) {
      last = &live;
    }
  }
  if (last != nullptr) {
    tellMode(*last, now(), *last->mode, steadyNow());
  }
}

void LiveEvents::tellLatched(LiveConnection& live, std::int64_t stamp, std::int64_t steady_time) {
  if (const auto id = live.encoder->latched()) {
    live.latched = true;
    tell(live, {stamp, *id, {}}, steady_time);
  }
}

void LiveEvents::tellMode(LiveConnection& live, std::int64_t stamp, const Content& content,
                          std::int64_t steady_time) {
  tell(live, {stamp, live.encoder->mode(content.data(), content.size())}, steady_time);
}

std::int64_t LiveEvents::now() const {
  return handlers_.time(rosNow(), steadyNow());
}

void LiveEvents::deliver() {
  if (std::exchange(lasting_again_, false)) {
    tellLastingAgain();
  }
  const std::vector<Arrivals::Dropped> dropped = arrivals_.take(delivered_);
  for (const Arrival& arrival : delivered_) {
    onArrival(arrival);
  }
  for (const Arrivals::Dropped& of : dropped) {
    const auto known = connections_.find(of.header.get());
    if (known != connections_.end() && known->second.encoder) {
      handlers_.on_dropped({connectionFrom(*of.header, *of.topic).callerid, *of.topic});
    }
  }
  release();
  senders_.advance(steadyNow());
  delivered_.clear();  // now: whether a connection is closed is seen by the users of its header
}

void LiveEvents::onArrival(const Arrival& arrival) {
  if (!encoder_) {
    return;
  }
  LiveConnection& live = connectionOf(arrival);
  if (live.link) {
    senders_.add(arrival.steady, *live.link, std::nullopt);  // a connection is one sender's
  }
  std::optional<ConnectionEncoder>& encoder = live.encoder;
  if (!encoder) {
    return;
  }
  core::Event event{handlers_.time(arrival.stamp, arrival.steady), 0, {}};
  if (isRead(live, arrival)) {
    read(arrival);
    live.read_at = arrival.steady;
    event.attributes = live.attributes.read(content_, arrival.stamp);
    if (arrival.size > kLarge && !encoder->needsContent()) {
      arrivals_.dropContent(arrival.header.get(), arrival.steady + kBetweenReads);
    }
  } else {
    event.attributes = live.attributes.skip(arrival.size);
  }
  if (event.stamp != arrival.stamp) {
    event.attributes = {};  // the age is that by a clock which does not count
  }
  const bool accepted = encoder->accept();
  if (!accepted) {
    tellLatched(live, event.stamp, arrival.steady);
  }
  if (!accepted && !encoder->tellsMode()) {
    return;
  }
  if (!encoder->needsContent()) {
    event.id = encoder->id();
  } else if (!arrival.message) {
    return;  // it came for the encoder before
  } else {
    try {
      if (encoder->tellsMode()) {
        tellMode(live, event.stamp, content_, arrival.steady);
        live.mode = std::make_shared<const Content>(content_);
        live.mode_told = arrival.steady;
      }
      if (!accepted) {
        return;
      }
      if (const auto id = encoder->list(content_.data(), content_.size(), event.stamp)) {
        handlers_.on_content(*id, content_);
        tell(live, {event.stamp, *id, {}}, arrival.steady);
      }
      event.id = encoder->id(content_.data(), content_.size());
      handlers_.on_content(event.id, content_);
    } catch (const std::out_of_range& error) {
      ROS_ERROR_THROTTLE(10, "%s: %s; the message is left out", arrival.topic->c_str(),
                         printable(error.what(), kLongestName).c_str());
      return;
    }
  }
  tell(live, event, arrival.steady);
}

bool LiveEvents::isRead(const LiveConnection& live, const Arrival& arrival) {
  return arrival.message && (live.encoder->needsContent() || arrival.size <= kLarge ||
                             !live.read_at || arrival.steady - *live.read_at >= kBetweenReads);
}

void LiveEvents::read(const Arrival& arrival) {
  content_.resize(arrival.size);
  ros::serialization::OStream stream(content_.data(), arrival.size);
  arrival.message->write(stream);
}

void LiveEvents::tell(LiveConnection& live, const core::Event& event, std::int64_t steady_time) {
  if (!hold(live, event, steady_time)) {
    handlers_.on_event(event);
  }
}

bool LiveEvents::hold(LiveConnection& live, const core::Event& event, std::int64_t steady_time) {
  if (hold_ == 0) {
    return false;
  }
  if (!live.held_until) {
    const bool undecided =
        own_output_.mayCover(connectionFrom(*live.header, *live.topic).callerid, *live.topic);
    live.held_until = undecided ? steady_time + hold_ : steady_time;
  }
  if (steady_time >= *live.held_until) {
    return false;
  }
  live.held.push_back(event);
  if (live.held.size() == kMostHeld) {
    live.held_until = steady_time;
  }
  holds_ = true;
  return true;
}

void LiveEvents::release() {
  if (!holds_) {
    return;
  }
  const std::int64_t steady_now = steadyNow();
  const std::int64_t now = this->now();
  holds_ = false;
  for (auto& [key, live] : connections_) {
    if (!live.held.empty() && steady_now >= *live.held_until) {
      for (const core::Event& event : std::exchange(live.held, {})) {
        handlers_.on_event({now, event.id, event.attributes});
      }
    }
    holds_ = holds_ || !live.held.empty();
  }
}

LiveEvents::LiveConnection& LiveEvents::connectionOf(const Arrival& arrival) {
  const auto known = connections_.find(arrival.header.get());
  if (known != connections_.end()) {
    return known->second;
  }
  const Connection connection = connectionFrom(*arrival.header, *arrival.topic);
  return connections_
      .try_emplace(arrival.header.get(),
                   LiveConnection{arrival.header, arrival.topic, AttributeReader(connection),
                                  connect(connection), senders_.connect(connection, *encoder_)})
      .first->second;
}

std::optional<ConnectionEncoder> LiveEvents::connect(const Connection& connection) {
  if (own_output_.covers(connection.callerid, connection.topic)) {
    return std::nullopt;
  }
  const std::string why = whyLeftOut(connection);
  if (!why.empty() && complained_of_.add(why)) {
    ROS_WARN("%s; its messages are left out", why.c_str());
  }
  try {
    return encoder_->connect(connection);
  } catch (const std::invalid_argument& error) {
    if (complained_of_.add(connection.callerid + " " + connection.topic)) {
      ROS_ERROR("%s from %s: %s; its messages are left out", connection.topic.c_str(),
                printable(connection.callerid, kLongestName).c_str(),
                printable(error.what(), kLongestName).c_str());
    }
    return std::nullopt;
  }
}

}  // namespace self_awareness::ros1
