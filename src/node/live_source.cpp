#include "live_source.h"

#include "self_awareness/ros/ros_time.h"

namespace self_awareness {

LiveSource::LiveSource(ros::CallbackQueue& queue, const ros::NodeHandle& node_handle,
                       const LiveParameters& parameters, std::vector<std::string> services,
                       Listener& listener)
    : listener_(listener),
      period_(parameters.diagnostic_period),
      reported_at_(ros1::steadyNow()),
      timer_(node_handle.createSteadyTimer(tick_, &LiveSource::onTick, this)),
      live_events_(node_handle, parameters.queue_size, handlers()),
      discovery_(live_events_.arrivals(), parameters.subscribe, parameters.poll_interval,
                 std::move(services)),
      spinner_(1, &queue) {}

ros1::LiveEvents::Handlers LiveSource::handlers() {
  ros1::LiveEvents::Handlers handlers;
  handlers.on_event = [this](const core::Event& event) {
    if (!clock_watch_.isStale(event.stamp)) {
      listener_.onEvent(event);
    }
  };
  handlers.on_content = [this](core::EventId id, const ros1::Content& content) {
    listener_.onContent(id, content);
  };
  handlers.time = [this](std::int64_t ros_time, std::int64_t steady_time) {
    return contest_.timeOf(ros_time, steady_time);
  };
  handlers.on_arrivals = [this] {
    watchClock();
    deliver();
  };
  handlers.on_dropped = [this](const ros1::Publication& publication) {
    listener_.onDropped(publication);
  };
  handlers.on_senders = [this](const core::Senders& senders) { listener_.onSenders(senders); };
  return handlers;
}

void LiveSource::setWanted(Wanted wanted) {
  encoder_ = wanted.encoder;
  graph_.reset();
  tick_ = wanted.tick;
  timer_.setPeriod(tick_);
  live_events_.setEncoder(wanted.encoder, std::move(wanted.own_output), wanted.window,
                          wanted.encoder->tellsSources() ? wanted.hold : 0);
  discovery_.setWanted({std::move(wanted.model_topics), std::move(wanted.encoder)});
}

void LiveSource::report() {
  reported_at_ = ros1::steadyNow();
  listener_.onReport();
}

void LiveSource::onTick(const ros::SteadyTimerEvent& /*tick*/) {
  const std::int64_t now = watchClock();
  const Discovery::State discovered = discovery_.state();
  if (discovered.graph) {
    const auto clock = discovered.graph->topics.find("/clock");
    contest_.setPublishers(clock == discovered.graph->topics.end() ? std::set<std::string>()
                                                                   : clock->second.publishers);
  }
  if (std::exchange(master_restarts_, discovered.master_restarts) != discovered.master_restarts) {
    listener_.onMasterRestart(now);
  }
  if (encoder_ && discovered.graph && discovered.graph != graph_) {
    graph_ = discovered.graph;
    if (encoder_->tellsSources()) {
      live_events_.setGraph(*graph_);
    }
    listener_.onGraph(*graph_);
  }
  tellWaiting(now);  // before windows are judged that end now
  listener_.onTick(now);
  if (core::toSeconds(ros1::steadyNow() - reported_at_) >= period_) {
    live_events_.forgetClosedConnections();
    report();
  }
}

void LiveSource::tellWaiting(std::int64_t now) {
  if (const auto waiting = processor_watch_.look(now, ros1::steadyNow(), tick_.toNSec())) {
    listener_.onWaiting(*waiting);
  }
}

std::int64_t LiveSource::now() const {
  return contest_.timeOf(ros1::rosNow(), ros1::steadyNow());
}

std::string LiveSource::clockRivals() const {
  return ros::Time::isSimTime() ? contest_.rivals() : "";
}

std::int64_t LiveSource::watchClock() {
  const std::int64_t now =
      contest_.look(ros1::rosNow(), ros1::steadyNow(), ros::Time::isSimTime());
  if (clock_watch_.look(now, ros1::steadyNow(), ros::Time::isSimTime())) {
    processor_watch_.restart();
    listener_.onClockSet(now);
  } else if (clock_watch_.pause() > core::Waiting::kStoodStill + tick_.toNSec()) {
    listener_.onPause(clock_watch_.pause());
    tellWaiting(now);
  }
  return now;
}

}  // namespace self_awareness
