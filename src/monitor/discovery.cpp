#include "discovery.h"

#include <ros/console.h>
#include <ros/this_node.h>

#include <utility>

#include "self_awareness/ros/stable_name.h"

namespace self_awareness {
namespace {

// A master that takes longer than this to answer all that it is asked hangs.
constexpr std::chrono::seconds kPatience(5);

}  // namespace

Discovery::Discovery(ros1::LiveEvents& live_events, ros1::SubscribePolicy policy, double interval,
                     std::vector<std::string> services)
    : live_events_(live_events),
      policy_(policy),
      interval_(interval),
      registration_(std::move(services)),
      thread_([this] { run(); }) {}

Discovery::~Discovery() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void Discovery::setWanted(Wanted wanted) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    wanted_ = std::move(wanted);
    restart_ = true;
    poll_now_ = true;
  }
  wake_.notify_all();
}

void Discovery::restart() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    restart_ = true;
    poll_now_ = true;
  }
  wake_.notify_all();
}

void Discovery::pollNow() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    poll_now_ = true;
  }
  wake_.notify_all();
}

Discovery::State Discovery::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  State state = state_;
  if (asked_at_ && std::chrono::steady_clock::now() - *asked_at_ > kPatience) {
    state.master_answers = false;
  }
  return state;
}

std::vector<ros1::Publisher> Discovery::takeNewPublishers() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(new_publishers_, {});
}

void Discovery::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_) {
    poll_now_ = false;
    const bool restart = std::exchange(restart_, false);
    const Wanted wanted = wanted_;
    asked_at_ = std::chrono::steady_clock::now();
    lock.unlock();
    poll(wanted, restart);
    lock.lock();
    asked_at_.reset();
    wake_.wait_for(lock, interval_, [this] { return stopping_ || poll_now_; });
  }
}

void Discovery::poll(const Wanted& wanted, bool restart) {
  if (restart) {
    publishers_.restart();
  }
  State state;
  std::vector<ros1::Publisher> new_publishers;
  const ros1::MasterRegistration::Master master = registration_.check();
  std::optional<ros1::Graph> graph = ros1::fetchGraph();
  state.master_answers = master != ros1::MasterRegistration::Master::kAway && graph;
  if (state.master_answers) {
    if (master == ros1::MasterRegistration::Master::kRestarted) {
      ROS_WARN("the master was restarted: registered all topics and services again");
      live_events_.renew(*graph);
    }
    std::set<std::string> topics;
    if (wanted.encoder) {
      topics = ros1::chooseTopics(
          *graph, policy_, wanted.model_topics,
          [&](const std::string& topic) { return wanted.encoder->includesTopic(topic); },
          ros::this_node::getName());
    }
    live_events_.setTopics(topics, *graph);
    state.subscriptions = topics.size();
    if (wanted.encoder) {
      new_publishers =
          publishers_.look(*graph, topics, [&](const std::string& node, const std::string& topic) {
            return wanted.encoder->includesSource(ros1::stableName(node)) &&
                   !wanted.own_output.covers(node, topic);
          });
    }
    state.graph = std::make_shared<const ros1::Graph>(std::move(*graph));
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!state.master_answers) {
    state.subscriptions = state_.subscriptions;
  }
  if (!state.graph || (state_.graph && *state.graph == *state_.graph)) {
    state.graph = state_.graph;  // whoever looks at it need not look again
  }
  state_ = state;
  new_publishers_.insert(new_publishers_.end(), new_publishers.begin(), new_publishers.end());
}

}  // namespace self_awareness
