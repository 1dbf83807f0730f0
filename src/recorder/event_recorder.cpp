#include "event_recorder.h"

#include <ros/console.h>
#include <ros/this_node.h>

#include <boost/filesystem/operations.hpp>
#include <cmath>
#include <ctime>
#include <utility>
#include <vector>

#include "node/encoding_parameters.h"
#include "node/node_status.h"
#include "node/parameter_reader.h"
#include "ros/text.h"
#include "ros/verdict/diagnostic_status.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/output_file.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness {
namespace {

namespace fs = boost::filesystem;

constexpr double kTick = 0.1;  // [s]
constexpr double kBytesOfMegabyte = 1e6;
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
  // A file that a launch file reads may end its line: with that, no log could be read again.
  parameters.robot = reader.text("robot", parameters.robot);
  parameters.robot.erase(parameters.robot.find_last_not_of(" \t\r\n") + 1);
  parameters.robot = ros1::printable(parameters.robot);
  parameters.live.subscribe = reader.choice<SubscribePolicy>(
      "subscribe", "used", {{"used", SubscribePolicy::kUsed}, {"all", SubscribePolicy::kAll}});
  parameters.live.poll_interval =
      reader.seconds("poll_interval", parameters.live.poll_interval, {0.01, 3600});
  parameters.live.queue_size = static_cast<std::uint32_t>(reader.wholeNumber(
      "queue_size", static_cast<int>(parameters.live.queue_size), {1, 1000000}));
  reader.expectNamespace("encoding");
  parameters.encoding = loadEncoding(private_node_handle);
  parameters.live.diagnostic_period =
      reader.seconds("diagnostic_period", parameters.live.diagnostic_period, {0.1, 3600});
  parameters.diagnostics = reader.text("diagnostics", parameters.diagnostics);
  reader.warnOfUnknown();
  return parameters;
}

EventRecorder::File::File(const std::string& final_path)
    : path(final_path), log(final_path + kActive) {}

EventRecorder::EventRecorder(ros::NodeHandle node_handle,
                             const ros::NodeHandle& private_node_handle, std::function<void()> end)
    : private_node_handle_(private_node_handle),
      end_(std::move(end)),
      parameters_(Parameters::load(private_node_handle)),
      robot_start_(std::llround(parameters_.robot_start * 1e9)) {
  node_handle.setCallbackQueue(&queue_);
  private_node_handle_.setCallbackQueue(&queue_);
  diagnostics_ =
      node_handle.advertise<diagnostic_msgs::DiagnosticArray>(parameters_.diagnostics, 1);
  start_publisher_ =
      private_node_handle_.advertise<self_awareness::EventLogStart>("start", 1, true);
  finish_ = private_node_handle_.advertiseService("finish", &EventRecorder::onFinish, this);
  live_ = std::make_unique<LiveSource>(queue_, node_handle, parameters_.live,
                                       std::vector<std::string>{finish_.getService()}, *this);
  LiveSource::Wanted wanted;
  wanted.encoder = std::make_shared<const ros1::Encoder>(
      parameters_.encoding, [this](const core::EventType& type) {
        return ros1::internUpTo(ros1::kMostEventTypes, type, vocabulary_);
      });
  if (parameters_.encoding.mode) {
    wanted.model_topics.insert(parameters_.encoding.mode->topic);  // also if nobody else hears it
  }
  wanted.own_output = ros1::OwnOutput(ros::this_node::getName(), {});
  wanted.tick = ros::WallDuration(kTick);
  live_->setWanted(std::move(wanted));
  live_->start();
}

EventRecorder::~EventRecorder() {
  finish();
}

void EventRecorder::finish() {
  live_->stop();
  live_->deliver();
  end(ros1::rosNow());
}

void EventRecorder::onEvent(const core::Event& event) {
  lasting_.add(event, vocabulary_);
  if (!file_) {
    return;
  }
  ++events_;
  attempt([&] { packer_->add(event, vocabulary_); });
}

void EventRecorder::onWaiting(const core::Waiting& waiting) {
  if (file_) {
    packer_->add(waiting);
  }
}

void EventRecorder::onClockSet(std::int64_t now) {
  if (!file_) {
    return;
  }
  ROS_WARN("ROS time was set: a new recording begins");
  end(now);
  if (now != 0) {  // else simulated time has not begun again
    begin(now);
  }
}

void EventRecorder::onMasterRestart(std::int64_t now) {
  ROS_WARN("the master was restarted: the next recording is of another start of the robot");
  robot_start_ = ros1::wallNow();
  lasting_.forget();
  end(now);
}

void EventRecorder::onTick(std::int64_t now) {
  if (now == 0 || finished_) {  // 0: simulated time has not begun
    return;
  }
  if (!file_) {
    begin(now);
  }
  live_->deliver();
  if (file_) {
    attempt([&] {
      packer_->setDropped(live_->events().dropped());
      packer_->advance(now - kGrace);
      if (live_->graph() && live_->graph() != graph_) {
        graph_ = live_->graph();
        file_->log.writeGraph(*graph_, now);
      }
    });
  }
  const double minutes = core::toSeconds(ros1::steadyNow() - began_) / 60;
  if (file_ && (minutes >= parameters_.split || !hasSpace())) {
    end(now);
    begin(now);
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
    ros1::checkFolder(parameters_.output);
    file_ = std::make_unique<File>(newPath());
    graph_.reset();
    packer_.emplace([this](self_awareness::EventLog part) { file_->log.write(std::move(part)); });
    const self_awareness::EventLogStart start =
        ros1::startOfRecording(parameters_.encoding, now, robot_start_, parameters_.robot);
    file_->log.start(start);
    start_publisher_.publish(start);
    for (const core::Event& event : lasting_.at(now)) {
      packer_->add(event, vocabulary_);
    }
    began_ = ros1::steadyNow();
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
  return error || static_cast<double>(space.available) >= parameters_.min_space * kBytesOfMegabyte;
}

bool EventRecorder::onFinish(std_srvs::Trigger::Request& /*request*/,
                             std_srvs::Trigger::Response& response) {
  live_->deliver();
  end(ros1::rosNow());
  finished_ = true;
  response.success = problem_.empty();
  response.message = problem_.empty() ? std::to_string(files_) + " files" : problem_;
  end_();
  return true;
}

void EventRecorder::onReport() {
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
  tellClock(live_->clock().standsStillFor(), ros1::rosNow(), status);
  tellUnheard(live_->discovery().unheard(), ros1::ListsAre::kTold, status);
  status.add("file", file_ ? file_->log.path() : "none");
  status.add("files before", files_);
  status.add("events", events_);
  status.add("size [MB]",
             static_cast<double>(bytes_ + (file_ ? file_->log.size() : 0)) / kBytesOfMegabyte);
  status.add("dropped messages", live_->events().dropped());
  status.add("event types", vocabulary_.size());
  ros1::DiagnosticStatuses statuses(ros::this_node::getName(), ros1::kNoHardware, ros1::rosNow());
  statuses.add("recording", status);
  diagnostics_.publish(statuses.message());
}

}  // namespace self_awareness
