#include "discovery.h"

#include <ros/console.h>
#include <ros/this_node.h>

#include <utility>

namespace self_awareness {
namespace {

// A master that takes longer than this to answer all that it is asked hangs.
constexpr std::chrono::seconds kPatience(5);

}  // namespace

Discovery::Discovery(const ros::NodeHandle& node_handle, ros1::Arrivals& arrivals,
                     ros1::SubscribePolicy policy, double interval,
                     std::vector<std::string> services)
    : policy_(policy),
      interval_(interval),
      registration_(std::move(services)),
      subscriptions_(node_handle, arrivals),
      thread_([this] { run(); }) {}

Discovery::~Discovery() {
  shared_.lock()->stopping = true;
  wake_.notify_all();
  thread_.join();
}

void Discovery::setWanted(Wanted wanted) {
  {
    const auto shared = shared_.lock();
    shared->wanted = std::move(wanted);
    shared->poll_now = true;
  }
  wake_.notify_all();
}

void Discovery::pollNow() {
  shared_.lock()->poll_now = true;
  wake_.notify_all();
}

Discovery::State Discovery::state() const {
  const auto shared = shared_.lock();
  State state = shared->state;
  if (shared->asked_at && std::chrono::steady_clock::now() - *shared->asked_at > kPatience) {
    state.master_answers = false;
  }
  return state;
}

void Discovery::run() {
  while (const std::optional<Wanted> next = awaitPoll()) {
    poll(*next);
    shared_.lock()->asked_at.reset();
  }
}

std::optional<Discovery::Wanted> Discovery::awaitPoll() {
  auto shared = shared_.lock();
  shared.waitFor(wake_, interval_, [](const Shared& now) { return now.stopping || now.poll_now; });
  if (shared->stopping) {
    return std::nullopt;
  }
  shared->poll_now = false;
  shared->asked_at = std::chrono::steady_clock::now();
  return shared->wanted;
}

void Discovery::poll(const Wanted& wanted) {
  subscriptions_.adaptReading();  // at once, whether the master answers or not
  State state;
  const ros1::MasterRegistration::Master master = registration_.check();
  std::optional<ros1::Graph> graph = ros1::fetchGraph();
  state.master_answers = master != ros1::MasterRegistration::Master::kAway && graph;
  if (state.master_answers) {
    if (master == ros1::MasterRegistration::Master::kRestarted) {
      ROS_WARN("the master was restarted: registered all topics and services again");
      subscriptions_.renew(*graph);
    }
    std::set<std::string> topics;
    if (wanted.encoder) {
      topics = ros1::chooseTopics(
          *graph, policy_, wanted.model_topics,
          [&](const std::string& topic) { return wanted.encoder->includesTopic(topic); },
          ros::this_node::getName());
    }
    subscriptions_.setTopics(topics, *graph);
    state.subscriptions = topics.size();
    state.graph = std::make_shared<const ros1::Graph>(std::move(*graph));
  }
  const auto shared = shared_.lock();
  state.master_restarts = shared->state.master_restarts +
                          (master == ros1::MasterRegistration::Master::kRestarted ? 1 : 0);
  if (!state.master_answers) {
    state.subscriptions = shared->state.subscriptions;
  }
  if (!state.graph || (shared->state.graph && *state.graph == *shared->state.graph)) {
    state.graph = shared->state.graph;  // its users see that nothing changed
  }
  shared->state = state;
}

}  // namespace self_awareness
