#include "monitor.h"

#include <ros/console.h>
#include <ros/this_node.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "self_awareness/core/evidence/judge.h"
#include "self_awareness/core/paper/judge.h"
#include "verdict_message.h"

namespace self_awareness {
namespace {

// Messages that came before a window's end may wait in the queue for this long when it is closed.
constexpr std::int64_t kGrace = 20000000;  // [ns]
constexpr int kTicksPerWindow = 4;
constexpr std::size_t kMostUnknownTypes = 1000;

ros::Time toRosTime(std::int64_t nanoseconds) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(std::max<std::int64_t>(nanoseconds, 0)));
  return time;
}

ros::WallDuration tickFor(std::int64_t window) {
  return ros::WallDuration(core::toSeconds(window) / kTicksPerWindow);
}

std::int64_t rosNow() {
  return static_cast<std::int64_t>(ros::Time::now().toNSec());
}

std::int64_t steadyNow() {
  return static_cast<std::int64_t>(ros::SteadyTime::now().toNSec());
}

}  // namespace

Monitor::Session::Session(ros1::TrainedModel trained_model, const MonitorParameters& parameters,
                          core::Detector::Handler handler)
    : trained(std::move(trained_model)),
      calibrated(parameters.method == MonitorParameters::Method::kPaper
                     ? trained.calibration.has_value()
                     : trained.evidence_calibration.has_value()),
      graph(std::make_shared<core::SourceGraph>(trained.graph)),
      vocabulary(trained.vocabulary()),
      encoder(std::make_shared<ros1::Encoder>(
          trained.encoding, [this](const core::EventType& type) { return intern(type); })),
      detector(makeJudge(parameters), trained.window, parameters.detector, std::move(handler)) {
  // The judge has made of them what it needs.
  trained.dropCounts();
  trained.watched = {};
}

std::unique_ptr<core::Judge> Monitor::Session::makeJudge(
    const MonitorParameters& parameters) const {
  if (parameters.method == MonitorParameters::Method::kPaper) {
    trained.requireDelays();
    return core::paper::makeJudge(std::make_shared<core::paper::Model>(trained.statistics),
                                  trained.threshold(), parameters.detector.silence_is_abnormal);
  }
  trained.requireWatched();
  return core::evidence::makeJudge(std::make_shared<core::evidence::Model>(trained.watched),
                                   trained.limits(), trained.window, graph);
}

// A type field with ever new values must not fill the memory of a robot that runs for months.
core::EventId Monitor::Session::intern(const core::EventType& type) {
  const std::size_t known = trained.vocabulary().size();
  if (!vocabulary.find(type) && vocabulary.size() >= known + kMostUnknownTypes) {
    return vocabulary.intern({"", "(further topics)", "(further unknown events)"});
  }
  return vocabulary.intern(type);
}

Monitor::Monitor(const ros::NodeHandle& node_handle, const ros::NodeHandle& private_node_handle,
                 const std::string& name)
    : node_handle_(node_handle),
      private_node_handle_(private_node_handle),
      parameters_(MonitorParameters::load(private_node_handle)),
      diagnostics_(node_handle, private_node_handle, name, parameters_.hardware_id,
                   parameters_.source_diagnostics),
      last_report_(ros::SteadyTime::now()),
      spinner_(1, &queue_) {
  node_handle_.setCallbackQueue(&queue_);
  private_node_handle_.setCallbackQueue(&queue_);
  status_publisher_ = private_node_handle_.advertise<self_awareness::SelfAwareness>("status", 100);
  alarm_publisher_ =
      private_node_handle_.advertise<self_awareness::SelfAwareness>("alarm", 10, true);
  services_ = {private_node_handle_.advertiseService("reset", &Monitor::onReset, this),
               private_node_handle_.advertiseService("clear", &Monitor::onClear, this),
               private_node_handle_.advertiseService("reload", &Monitor::onReload, this)};
  std::vector<std::string> service_names;
  for (const ros::ServiceServer& service : services_) {
    service_names.push_back(service.getService());
  }
  ros1::LiveEvents::Handlers handlers;
  handlers.on_event = [this](const core::Event& event) { onEvent(event); };
  // It may be a publisher that the master has not told of: settling cannot wait for the next poll.
  handlers.on_connection = [this] { discovery_->pollNow(); };
  handlers.on_arrivals = [this] { onArrivals(); };
  live_events_ =
      std::make_unique<ros1::LiveEvents>(node_handle_, parameters_.queue_size, handlers);
  timer_ = private_node_handle_.createSteadyTimer(tickFor(core::kDefaultWindow), &Monitor::onTick,
                                                  this);
  discovery_ = std::make_unique<Discovery>(*live_events_, parameters_.subscribe,
                                           parameters_.poll_interval, service_names);
  try {
    load();
  } catch (const ros1::ModelFileError& error) {
    // Not fatal: the operator sees it in the diagnostics, and ~reload mends it.
    model_error_ = error.what();
    ROS_ERROR("%s", error.what());
  }
  spinner_.start();
}

Monitor::~Monitor() {
  spinner_.stop();  // first: what it serves uses the others
  discovery_.reset();
  live_events_.reset();
}

void Monitor::load() {
  if (parameters_.model.empty()) {
    throw ros1::ModelFileError(private_node_handle_.resolveName("model") +
                               " is not set; give it the path of a model file");
  }
  startSession(
      ros1::loadModel(parameters_.model, parameters_.method == MonitorParameters::Method::kPaper
                                             ? ros1::ModelCounts::kDelays
                                             : ros1::ModelCounts::kWatched));
}

std::unique_ptr<Monitor::Session> Monitor::makeSession(ros1::TrainedModel trained) {
  try {
    return std::make_unique<Session>(std::move(trained), parameters_,
                                     [this](const core::Verdict& verdict) { onVerdict(verdict); });
  } catch (const std::invalid_argument& error) {
    throw ros1::ModelFileError(parameters_.model + ": " + error.what());
  }
}

void Monitor::startSession(ros1::TrainedModel trained) {
  session_ = makeSession(std::move(trained));
  model_error_.clear();
  // Whatever was said of a window was the old model's; an alarm stands until standDown() says that
  // it does not.
  const auto level = last_.level;
  last_ = {};
  last_.level = level;
  graph_.reset();
  timer_.setPeriod(tickFor(session_->trained.window));
  components_.clear();
  component_of_.clear();
  Discovery::Wanted wanted;
  wanted.encoder = session_->encoder;
  std::set<std::string> own_topics;
  for (const core::EventType& type : session_->trained.vocabulary().types()) {
    wanted.model_topics.insert(type.scope);
    if (type.source == ros::this_node::getName()) {
      own_topics.insert(type.scope);
    }
    component_of_.push_back(&components_[core::componentOf(type.source, type.scope)]);
  }
  wanted.own_output = ros1::OwnOutput(ros::this_node::getName(), std::move(own_topics));
  live_events_->setEncoder(session_->encoder, wanted.own_output, session_->trained.window);
  discovery_->setWanted(std::move(wanted));
  ROS_INFO("model %s: %zu event types of %zu components, %s", parameters_.model.c_str(),
           component_of_.size(), components_.size(),
           session_->calibrated ? "calibrated" : "not calibrated, it will never alarm");
}

void Monitor::onArrivals() {
  const ros::WallTime begin = ros::WallTime::now();
  watchClock();
  live_events_->deliver();
  processing_ += ros::WallTime::now() - begin;
}

void Monitor::onEvent(const core::Event& event) {
  if (clock_watch_.isStale(event.stamp)) {
    return;
  }
  if (event.id < component_of_.size()) {
    component_of_[event.id]->last = event.stamp;
    ++component_of_[event.id]->events;
  }
  ++events_;
  if (!session_->detector.add(event)) {
    restart();
    session_->detector.add(event);
  }
}

void Monitor::onTick(const ros::SteadyTimerEvent& /*tick*/) {
  const ros::WallTime begin = ros::WallTime::now();
  const std::int64_t now = watchClock();
  live_events_->deliver();
  if (session_) {
    for (const ros1::Publisher& publisher : discovery_->takeNewPublishers()) {
      ROS_INFO("settling: %s began to publish %s", publisher.source.c_str(),
               publisher.topic.c_str());
      session_->detector.settle(now);
    }
    session_->detector.advance(now - kGrace);
  }
  processing_ += ros::WallTime::now() - begin;
  if ((ros::SteadyTime::now() - last_report_).toSec() >= diagnostics_.period()) {
    live_events_->forgetClosedConnections();
    publishDiagnostics();
  }
}

std::int64_t Monitor::watchClock() {
  const std::int64_t now = rosNow();
  const bool set = clock_watch_.look(now, steadyNow(), ros::Time::isSimTime());
  if (set && session_ && session_->detector.started()) {  // else there is nothing to start afresh
    restart();
  }
  return now;
}

void Monitor::restart() {
  ++clock_steps_;
  ROS_WARN("ROS time was set: delays and windows start afresh");
  session_->detector.restart();
  for (auto& [name, heard] : components_) {
    heard.last.reset();
  }
  standDown("settling: ROS time was set");
}

void Monitor::onVerdict(const core::Verdict& verdict) {
  const std::int64_t end = verdict.window->start + session_->trained.window;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!verdict.suspects.empty() || !(verdict.alarm || verdict.suspicion)) {
    suspects_ = toMessages(verdict.suspects, session_->vocabulary);
  }
  if (verdict.changed) {
    level_since_ = end;
  }
  last_.header.stamp = toRosTime(end);
  last_.level = levelOf(verdict);
  if (!verdict.evidence.empty() || last_.level == self_awareness::SelfAwareness::OK) {
    last_.evidence = verdict.evidence;
  }
  last_.message = wording(verdict, last_.evidence, suspects_);
  last_.window_start = toRosTime(verdict.window->start);
  last_.window.fromNSec(session_->trained.window);
  last_.score = verdict.score.value_or(kNone);
  last_.threshold = verdict.threshold.value_or(kNone);
  last_.abnormal = verdict.abnormal && !verdict.settling;
  last_.settling = verdict.settling;
  last_.events = static_cast<std::uint32_t>(verdict.window->events.size());
  last_.unknown_events = static_cast<std::uint32_t>(verdict.window->unknown());
  last_.suspects = suspects_;
  status_publisher_.publish(last_);
  if (verdict.changed) {
    if (verdict.alarm) {
      ROS_ERROR("%s", last_.message.c_str());
    } else if (verdict.suspicion) {
      ROS_WARN("%s", last_.message.c_str());
    } else {
      ROS_INFO("%s", last_.message.c_str());
    }
    alarm_publisher_.publish(last_);
    publishDiagnostics();
  }
}

void Monitor::standDown(const std::string& message) {
  const bool stood = last_.level != self_awareness::SelfAwareness::OK;
  suspects_.clear();
  last_.level = self_awareness::SelfAwareness::OK;
  last_.message = message;
  last_.abnormal = false;
  last_.suspects.clear();
  last_.evidence.clear();
  last_.header.stamp = ros::Time::now();
  if (stood) {
    ROS_INFO("%s", message.c_str());
    alarm_publisher_.publish(last_);
  }
  publishDiagnostics();
}

// Whoever was killed, or has gone since, is still upstream of its victims: edges are added only.
void Monitor::refreshGraph(const std::shared_ptr<const ros1::Graph>& graph) {
  if (!session_ || !graph || graph == graph_) {
    return;
  }
  graph_ = graph;
  ros1::addEdges(*graph, ros::this_node::getName(), *session_->graph);
}

void Monitor::publishDiagnostics() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  const double elapsed = std::max((now - last_report_).toSec(), 1e-3);
  const Discovery::State discovered = discovery_->state();
  refreshGraph(discovered.graph);
  ros1::MonitorState state;
  state.model = parameters_.model;
  state.model_error = model_error_;
  state.calibrated = session_ && session_->calibrated;
  state.started = session_ && !last_.message.empty();
  state.last = last_;
  state.level_for = core::toSeconds(rosNow() - level_since_);
  for (auto& [name, heard] : components_) {
    ros1::MonitorState::Component& component = state.components[name];
    if (heard.last) {
      component.last_heard = core::toSeconds(rosNow() - *heard.last);
    }
    component.rate = static_cast<double>(heard.events) / elapsed;
    heard.events = 0;
  }
  state.rate = static_cast<double>(events_) / elapsed;
  state.processing_share = processing_.toSec() / elapsed;
  state.subscriptions = discovered.subscriptions;
  state.connections = live_events_->connections();
  state.dropped = live_events_->dropped();
  state.newly_dropped = state.dropped - reported_drops_;
  state.clock_steps = clock_steps_;
  state.master_answers = discovered.master_answers;
  diagnostics_.publish(state);
  events_ = 0;
  processing_ = {};
  reported_drops_ = state.dropped;
  last_report_ = now;
}

bool Monitor::onReset(std_srvs::Trigger::Request& /*request*/,
                      std_srvs::Trigger::Response& response) {
  response.success = session_ != nullptr;
  response.message = session_ ? "delays, windows and the alarm start afresh" : model_error_;
  if (session_) {
    session_->detector.restart();
    discovery_->restart();
    standDown("settling: reset");
  }
  return true;
}

bool Monitor::onClear(std_srvs::Trigger::Request& /*request*/,
                      std_srvs::Trigger::Response& response) {
  const bool stood = last_.level != self_awareness::SelfAwareness::OK;
  response.success = true;
  response.message = stood ? "the alarm is cleared" : "there is no alarm";
  if (stood) {
    session_->detector.clearAlarm();
    standDown("cleared by hand");
  }
  return true;
}

bool Monitor::onReload(std_srvs::Trigger::Request& /*request*/,
                       std_srvs::Trigger::Response& response) {
  try {
    load();
  } catch (const ros1::ModelFileError& error) {
    response.success = false;
    response.message = std::string(error.what()) + (session_ ? "; the old model stays" : "");
    ROS_ERROR("%s", response.message.c_str());
    return true;
  }
  standDown("settling: model loaded");
  response.success = true;
  response.message = "loaded " + parameters_.model;
  return true;
}

}  // namespace self_awareness
