#include "discovery.h"

#include <ros/console.h>
#include <ros/this_node.h>

#include <utility>

#include "now.h"
#include "self_awareness/ros/stable_name.h"

namespace self_awareness {
namespace {

// A master that takes longer than this to answer all that it is asked hangs.
constexpr std::chrono::seconds kPatience(5);
// To look for lost publishers costs more than a poll, where there are many.
constexpr std::int64_t kBetweenLooks = 3 * core::kNanosecondsPerSecond;

// Topics that are subscribed to stay: the first by name may be anybody's.
std::size_t leaveOutMost(const std::set<std::string>& model_topics,
                         const std::set<std::string>& before, std::set<std::string>& topics) {
  const std::set<std::string> wanted = std::exchange(topics, {});
  std::size_t others = 0;
  const auto take = [&](const std::string& topic) {
    const bool of_model = model_topics.count(topic) > 0;
    if (topics.count(topic) == 0 && (of_model || others < Discovery::kMostOthers)) {
      topics.insert(topic);
      others += of_model ? 0 : 1;
    }
  };
  for (const std::string& topic : wanted) {
    if (before.count(topic) > 0) {
      take(topic);
    }
  }
  for (const std::string& topic : wanted) {
    take(topic);
  }
  return wanted.size() - topics.size();
}

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
  using ros1::MasterRegistration;
  subscriptions_.adaptReading();  // at once, whether the master answers or not
  State state;
  const MasterRegistration::Master master = registration_.check();
  std::optional<ros1::Graph> graph = ros1::fetchGraph();
  state.master_answers = master != MasterRegistration::Master::kAway && graph;
  if (state.master_answers) {
    nameIllegal(wanted, *graph);
    subscribe(wanted, *graph, master == MasterRegistration::Master::kRestarted, state);
    state.graph = std::make_shared<const ros1::Graph>(std::move(*graph));
  }
  const auto shared = shared_.lock();
  state.master_restarts = shared->state.master_restarts +
                          (master == ros1::MasterRegistration::Master::kRestarted ? 1 : 0);
  if (!state.master_answers) {
    state.subscriptions = shared->state.subscriptions;
    state.left_out = shared->state.left_out;
  }
  if (!state.graph || (shared->state.graph && *state.graph == *shared->state.graph)) {
    state.graph = shared->state.graph;  // its users see that nothing changed
  }
  shared->state = state;
}

void Discovery::subscribe(const Wanted& wanted, const ros1::Graph& graph, bool master_restarted,
                          State& state) {
  std::set<std::string> again;
  if (steadyNow() >= looked_for_lost_ + kBetweenLooks) {
    looked_for_lost_ = steadyNow();
    again = lost_publishers_.look(ros1::linksToPublishers(), looked_for_lost_);
  }
  if (master_restarted) {
    ROS_WARN("the master was restarted: registered all topics and services again");
    // roscpp does not hear of those that registered before it did.
    for (const auto& [name, topic] : graph.topics) {
      if (!topic.publishers.empty()) {
        again.insert(name);
      }
    }
  }
  subscriptions_.renew(again);
  std::set<std::string> topics;
  if (wanted.encoder) {
    const ros1::Encoder& encoder = *wanted.encoder;
    topics = ros1::chooseTopics(
        graph, policy_, wanted.model_topics,
        [&](const std::string& topic) { return encoder.includesTopic(topic); },
        [&](const std::string& node) {
          return node != ros::this_node::getName() && encoder.listens(ros1::stableName(node));
        });
  }
  state.left_out = leaveOutMost(wanted.model_topics, topics_, topics);
  topics_ = topics;
  subscriptions_.setTopics(topics, graph);
  state.subscriptions = topics.size();
}

void Discovery::nameIllegal(const Wanted& wanted, const ros1::Graph& graph) {
  const auto name = [this](const std::string& topic) {
    const std::string why = ros1::whyLeftOut(topic);
    if (!why.empty() && illegal_.add(why)) {
      ROS_WARN("%s; it is left out", why.c_str());
    }
  };
  for (const auto& [topic, nodes] : graph.topics) {
    if (!nodes.publishers.empty()) {
      name(topic);
    }
  }
  for (const std::string& topic : wanted.model_topics) {
    name(topic);
  }
}

}  // namespace self_awareness
