#include "event_recorder.h"

#include <ros/console.h>
#include <ros/this_node.h>

#include <boost/filesystem/operations.hpp>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <utility>
#include <vector>

#include "clock_status.h"
#include "encoding_parameters.h"
#include "now.h"
#include "parameter_reader.h"
#include "ros/verdict/diagnostic_status.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/output_file.h"

namespace self_awareness {
namespace {

namespace fs = boost::filesystem;

constexpr double kTick = 0.1;  // [s]
constexpr double kMegabyte = 1e6;
constexpr double kLatestTime = 4294967295;  // that ROS can say [s since 1970]
constexpr char kActive[] = ".active";

}  // namespace

EventRecorder::Parameters EventRecorder::Parameters::load(
    const ros::NodeHandle& private_node_handle) {
  using ros1::SubscribePolicy;
  Parameters parameters;
  ParameterReader reader(private_node_handle);
  parameters.output = reader.text("output", parameters.output);
  parameters.split = reader.number("split", parameters.split, {0.1, 10000}, "minutes");
  parameters.min_space = reader.number("min_space", parameters.min_space, {0, 1e15}, "MB");
  parameters.robot_start =
      reader.seconds("robot_start", ros::WallTime::now().toSec(), {0, kLatestTime});
  parameters.subscribe = reader.choice<SubscribePolicy>(
      "subscribe", "used", {{"used", SubscribePolicy::kUsed}, {"all", SubscribePolicy::kAll}});
  parameters.poll_interval =
      reader.seconds("poll_interval", parameters.poll_interval, {0.01, 3600});
  parameters.queue_size = static_cast<std::uint32_t>(
      reader.wholeNumber("queue_size", static_cast<int>(parameters.queue_size), {1, 1000000}));
  reader.expectNamespace("encoding");
  parameters.encoding = loadEncoding(private_node_handle);
  parameters.diagnostic_period =
      reader.seconds("diagnostic_period", parameters.diagnostic_period, {0.1, 3600});
  parameters.diagnostics = reader.text("diagnostics", parameters.diagnostics);
  reader.warnOfUnknown();
  return parameters;
}

EventRecorder::File::File(const std::string& final_path)
    : path(final_path), log(final_path + kActive) {}

EventRecorder::EventRecorder(const ros::NodeHandle& node_handle,
                             const ros::NodeHandle& private_node_handle, std::function<void()> end)
    : node_handle_(node_handle),
      private_node_handle_(private_node_handle),
      end_(std::move(end)),
      parameters_(Parameters::load(private_node_handle)),
      tells_sources_(parameters_.encoding.source == ros1::EncodingRules::Source::kCallerId),
      robot_start_(std::llround(parameters_.robot_start * 1e9)),
      diagnosed_(steadyNow()),
      spinner_(1, &queue_) {
  node_handle_.setCallbackQueue(&queue_);
  private_node_handle_.setCallbackQueue(&queue_);
  diagnostics_ =
      node_handle_.advertise<diagnostic_msgs::DiagnosticArray>(parameters_.diagnostics, 1);
  start_publisher_ =
      private_node_handle_.advertise<self_awareness::EventLogStart>("start", 1, true);
  finish_ = private_node_handle_.advertiseService("finish", &EventRecorder::onFinish, this);
  ros1::LiveEvents::Handlers handlers;
  handlers.on_event = [this](const core::Event& event) { onEvent(event); };
  handlers.on_connection = [this] { discovery_->pollNow(); };
  handlers.on_arrivals = [this] {
    watchClock(rosNow());
    live_events_->deliver();
  };
  live_events_ =
      std::make_unique<ros1::LiveEvents>(node_handle_, parameters_.queue_size, handlers);
  const auto encoder = std::make_shared<const ros1::Encoder>(
      parameters_.encoding, [this](const core::EventType& type) {
        return ros1::internUpTo(ros1::kMostEventTypes, type, vocabulary_);
      });
  live_events_->setEncoder(encoder, ros1::OwnOutput(ros::this_node::getName(), {}),
                           core::kDefaultWindow);
  discovery_ = std::make_unique<Discovery>(node_handle_, live_events_->arrivals(),
                                           parameters_.subscribe, parameters_.poll_interval,
                                           std::vector<std::string>{finish_.getService()});
  Discovery::Wanted wanted;
  wanted.encoder = encoder;
  discovery_->setWanted(std::move(wanted));
  timer_ = private_node_handle_.createSteadyTimer(ros::WallDuration(kTick), &EventRecorder::onTick,
                                                  this);
  spinner_.start();
}

EventRecorder::~EventRecorder() {
  finish();
  discovery_.reset();
  live_events_.reset();
}

void EventRecorder::finish() {
  spinner_.stop();  // first: what it serves uses the others
  live_events_->deliver();
  end(rosNow());
}

void EventRecorder::onEvent(const core::Event& event) {
  if (clock_watch_.isStale(event.stamp) || !file_) {
    return;
  }
  ++events_;
  attempt([&] { packer_->add(event, vocabulary_); });
}

void EventRecorder::onTick(const ros::SteadyTimerEvent& /*tick*/) {
  const std::int64_t now = rosNow();
  const Discovery::State discovered = discovery_->state();
  watchClock(now);
  watchMaster(now, discovered.master_restarts);
  if (now != 0 && !finished_) {  // else simulated time has not begun
    record(now, discovered.graph);
  }
  if (core::toSeconds(steadyNow() - diagnosed_) >= parameters_.diagnostic_period) {
    diagnosed_ = steadyNow();
    live_events_->forgetClosedConnections();
    publishDiagnostics();
  }
}

void EventRecorder::record(std::int64_t now, const std::shared_ptr<const ros1::Graph>& graph) {
  if (!file_) {
    begin(now);
  }
  if (graph && graph != known_graph_) {
    known_graph_ = graph;
    if (tells_sources_) {
      live_events_->setGraph(*graph);
    }
  }
  live_events_->deliver();
  if (file_) {
    attempt([&] {
      packer_->setDropped(live_events_->dropped());
      packer_->advance(now - kGrace);
      if (graph && graph != graph_) {
        file_->log.writeGraph(*graph, now);
        graph_ = graph;
      }
    });
  }
  const double minutes = core::toSeconds(steadyNow() - began_) / 60;
  if (file_ && (minutes >= parameters_.split || !hasSpace())) {
    end(now);
    begin(now);
  }
}

void EventRecorder::watchClock(std::int64_t now) {
  const bool set = clock_watch_.look(now, steadyNow(), ros::Time::isSimTime());
  if (!set || !file_) {
    return;
  }
  ROS_WARN("ROS time was set: a new recording begins");
  end(now);
  if (now != 0) {  // else simulated time has not begun again
    begin(now);
  }
}

void EventRecorder::watchMaster(std::int64_t now, std::size_t restarts) {
  if (restarts != master_restarts_) {
    ROS_WARN("the master was restarted: the next recording is of another start of the robot");
    master_restarts_ = restarts;
    robot_start_ = wallNow();
    end(now);
  }
}

void EventRecorder::begin(std::int64_t now) {
  if (!hasSpace()) {
    if (problem_.empty()) {
      problem_ = "less than " + std::to_string(std::lround(parameters_.min_space)) +
                 " MB are free (min_space)";
      ROS_ERROR("%s: nothing is recorded: %s", parameters_.output.c_str(), problem_.c_str());
    }
    return;
  }
  attempt([&] {
    file_ = std::make_unique<File>(newPath());
    graph_.reset();
    packer_.emplace([this](self_awareness::EventLog part) { file_->log.write(std::move(part)); });
    const self_awareness::EventLogStart start =
        ros1::startOfRecording(parameters_.encoding, now, robot_start_);
    file_->log.start(start);
    start_publisher_.publish(start);
    began_ = steadyNow();
    problem_.clear();
    ROS_INFO("recording to %s", file_->log.path().c_str());
  });
}

void EventRecorder::end(std::int64_t now) {
  if (!file_) {
    return;
  }
  attempt([&] {
    packer_->flush(now);
    file_->log.close();
    ros1::putInPlace(file_->log.path(), file_->path);
    bytes_ += file_->log.size();
    ++files_;
  });
  file_.reset();
}

void EventRecorder::attempt(const std::function<void()>& write) {
  try {
    write();
  } catch (const std::exception& error) {  // the disk is full, or was removed
    if (problem_ != error.what()) {
      problem_ = error.what();
      ROS_ERROR("nothing is recorded: %s", error.what());
    }
    file_.reset();
  }
}

std::string EventRecorder::newPath() const {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char date[32];
  std::strftime(date, sizeof date, "_%Y-%m-%d-%H-%M-%S", &local);
  std::string path = parameters_.output + date + ".bag";
  for (int k = 1; fs::exists(path) || fs::exists(path + kActive); ++k) {
    path = parameters_.output + date + "_" + std::to_string(k) + ".bag";
  }
  return path;
}

bool EventRecorder::hasSpace() const {
  const fs::path folder = fs::absolute(parameters_.output).parent_path();
  boost::system::error_code error;
  const fs::space_info space = fs::space(folder, error);
  // Without an answer, the attempt to write tells.
  return error || static_cast<double>(space.available) >= parameters_.min_space * kMegabyte;
}

bool EventRecorder::onFinish(std_srvs::Trigger::Request& /*request*/,
                             std_srvs::Trigger::Response& response) {
  live_events_->deliver();
  end(rosNow());
  finished_ = true;
  response.success = problem_.empty();
  response.message = problem_.empty() ? std::to_string(files_) + " files" : problem_;
  end_();
  return true;
}

void EventRecorder::publishDiagnostics() const {
  using diagnostic_msgs::DiagnosticStatus;
  diagnostic_updater::DiagnosticStatusWrapper status;
  if (problem_.empty()) {
    status.summary(DiagnosticStatus::OK, "recording");
  } else {
    status.summary(DiagnosticStatus::ERROR, "nothing is recorded: " + problem_);
  }
  if (vocabulary_.size() > ros1::kMostEventTypes) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        "more than " + std::to_string(ros1::kMostEventTypes) +
                            " event types: further ones are not told apart");
  }
  tellClock(clock_watch_.standsStillFor(), rosNow(), status);
  status.add("file", file_ ? file_->log.path() : "none");
  status.add("files before", files_);
  status.add("events", events_);
  status.add("size [MB]",
             static_cast<double>(bytes_ + (file_ ? file_->log.size() : 0)) / kMegabyte);
  status.add("dropped messages", live_events_->dropped());
  status.add("event types", vocabulary_.size());
  ros1::DiagnosticStatuses statuses(ros::this_node::getName(), ros1::kNoHardware, rosNow());
  statuses.add("recording", status);
  diagnostics_.publish(statuses.message());
}

}  // namespace self_awareness
