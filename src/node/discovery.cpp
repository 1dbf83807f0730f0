#include "discovery.h"

#include <ros/console.h>
#include <ros/this_node.h>

#include <utility>

#include "self_awareness/ros/stable_name.h"

namespace self_awareness {
namespace {

// A master that takes longer than this to answer all that it is asked hangs.
constexpr std::chrono::seconds kPatience(5);
// A node that takes longer than this to say who it is hangs.
constexpr std::chrono::milliseconds kPatienceOfNode(500);

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

// The topics of the model as this robot calls them: those that are published, and those that
// nobody has published yet, under the name that the model has for them.
std::set<std::string> topicsOfModel(const Discovery::Wanted& wanted, const ros1::Graph& graph) {
  std::set<std::string> topics = wanted.model_topics;
  for (const auto& [topic, nodes] : graph.topics) {
    if (wanted.encoder && wanted.model_topics.count(wanted.encoder->scopeOf(topic)) > 0) {
      topics.insert(topic);
    }
  }
  return topics;
}

// Also notes on which computers these publishers run.
ros1::Listening publishersOf(const std::set<std::string>& topics,
                             const std::set<std::string>& first, ros1::Graph& graph) {
  std::set<std::string> nodes;
  for (const std::string& topic : topics) {
    const auto known = graph.topics.find(topic);
    if (known != graph.topics.end()) {
      nodes.insert(known->second.publishers.begin(), known->second.publishers.end());
    }
  }
  std::map<std::string, std::string> addresses = ros1::fetchAddresses(nodes);
  for (const auto& [node, uri] : addresses) {
    if (const std::string host = ros1::hostIn(uri); !host.empty()) {
      graph.hosts[node] = host;
    }
  }
  graph.addresses = addresses;
  ros1::Listening listening;
  listening.first = first;
  for (const std::string& topic : topics) {
    std::set<ros1::Publisher>& publishers = listening.topics[topic];
    const auto known = graph.topics.find(topic);
    if (known != graph.topics.end()) {
      for (const std::string& node : known->second.publishers) {
        publishers.insert({node, addresses[node]});
      }
    }
  }
  return listening;
}

}  // namespace

Discovery::Discovery(ros1::Arrivals& arrivals, ros1::SubscribePolicy policy, double interval,
                     std::vector<std::string> services)
    : policy_(policy),
      interval_(interval),
      registration_(std::move(services)),
      subscriptions_(arrivals),
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
    askNodes();
  }
}

void Discovery::ask(std::vector<std::string> nodes) {
  {
    const auto shared = shared_.lock();
    shared->to_ask = std::move(nodes);
    shared->answers.reset();
    shared->poll_now = true;
  }
  wake_.notify_all();
}

void Discovery::askNodes() {
  const std::vector<std::string> nodes = std::exchange(shared_.lock()->to_ask, {});
  if (nodes.empty()) {
    return;
  }
  const auto end = std::chrono::steady_clock::now() + kLongestAsking;
  std::map<std::string, std::string> addresses =
      ros1::fetchAddresses({nodes.begin(), nodes.end()});
  Answers answers;
  for (const std::string& node : nodes) {
    if (!shared_.lock()->stopping && std::chrono::steady_clock::now() < end) {
      answers[node] = ros1::callNode(addresses[node], kPatienceOfNode);
    }
  }
  const auto shared = shared_.lock();
  if (shared->to_ask.empty()) {  // else others are asked already
    shared->answers = std::move(answers);
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
  State state;
  const MasterRegistration::Master master = registration_.check();
  const bool restarted = master == MasterRegistration::Master::kRestarted;
  std::optional<ros1::SystemState> known = ros1::fetchSystemState();
  state.master_answers = master != MasterRegistration::Master::kAway && known;
  shared_.lock()->asked_at.reset();
  if (state.master_answers) {
    nameIllegal(wanted, known->graph);
    listen(wanted, *known, restarted, state);
    state.graph = std::make_shared<const ros1::Graph>(std::move(known->graph));
  }
  const auto shared = shared_.lock();
  state.master_restarts = shared->state.master_restarts + (restarted ? 1 : 0);
  if (!state.master_answers) {
    state.subscriptions = shared->state.subscriptions;
    state.left_out = shared->state.left_out;
  }
  if (!state.graph || (shared->state.graph && *state.graph == *shared->state.graph)) {
    state.graph = shared->state.graph;  // its users see that nothing changed
  }
  shared->state = state;
}

void Discovery::listen(const Wanted& wanted, ros1::SystemState& known, bool master_restarted,
                       State& state) {
  ros1::Graph& graph = known.graph;
  const std::set<std::string> of_model = topicsOfModel(wanted, graph);
  std::set<std::string> topics;
  if (wanted.encoder) {
    const ros1::Encoder& encoder = *wanted.encoder;
    const ros1::Siblings siblings = ros1::siblingsIn(graph);
    topics = ros1::chooseTopics(
        graph, policy_, of_model,
        [&](const std::string& topic) { return encoder.includesTopic(topic); },
        [&](const std::string& node) {
          return node != ros::this_node::getName() && !siblings.has(node) &&
                 encoder.listens(ros1::stableName(node));
        });
  }
  state.left_out = leaveOutMost(of_model, topics_, topics);
  topics_ = topics;
  state.subscriptions = topics.size();
  const std::size_t vanished = registration_.keep(known);
  if (master_restarted) {
    ROS_WARN("the master was restarted: registered all topics and services again");
  } else if (vanished > 0) {
    ROS_WARN_THROTTLE(10,
                      "the master had forgotten %zu topics and services of this node: they are "
                      "registered again",
                      vanished);
  }
  subscriptions_.listen(publishersOf(topics, of_model, graph));
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
