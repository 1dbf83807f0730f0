#include "result_bag.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <boost/filesystem/operations.hpp>
#include <utility>

#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/file_version.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

// Only what a program names as its own work may be replaced by it. A field of the connection
// headers survives all that rosbag does with a bag, and disturbs nobody.
constexpr char kWriterField[] = "written_by";
constexpr char kWriter[] = "self_awareness score";

BagWriter::Topic topicOf(const std::string& name, bool latching = false) {
  return {name, std::string("/") + ResultBag::kNode, latching, {{kWriterField, kWriter}}};
}

std::string privateTopic(const std::string& name) {
  return std::string("/") + ResultBag::kNode + "/" + name;
}

ros::Time inBag(std::int64_t now) {
  return std::max(toRosTime(now), ros::TIME_MIN);
}

constexpr double kHeartbeat = 1;  // [s], as ~diagnostic_period is by default

}  // namespace

ResultBag::ResultBag(const std::string& path, const std::string& named)
    : bag_(path, BagWriter::Chunks::kCompressed, named) {}

template <typename Message>
void ResultBag::write(const std::string& topic, std::int64_t now, const Message& message,
                      bool latching) {
  if (!std::exchange(tells_version_, true)) {
    bag_.write(topicOf(kVersionTopic), inBag(now), versionOf(kResultBag));
  }
  bag_.write(topicOf(topic, latching), inBag(now), message);
}

bool ResultBag::isOne(const std::string& path) {
  // To open a pipe would wait for its writer.
  if (boost::system::error_code error; !boost::filesystem::is_regular_file(path, error)) {
    return false;
  }
  try {
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    rosbag::View view(bag);
    const std::vector<const rosbag::ConnectionInfo*> connections = view.getConnections();
    return !connections.empty() &&
           std::all_of(connections.begin(), connections.end(), [](const auto* connection) {
             const auto writer = connection->header->find(kWriterField);
             return writer != connection->header->end() && writer->second == kWriter;
           });
  } catch (const rosbag::BagException&) {  // no bag, or not a whole one
    return false;
  }
}

ReplayedMonitor::ReplayedMonitor(ResultBag& bag, const Model& model,
                                 const std::vector<core::EventType>& types, std::int64_t start)
    : bag_(bag),
      model_(model),
      vocabulary_(types),
      alarm_({[this](const self_awareness::SelfAwareness& status) {
                bag_.write(privateTopic("status"), now_, status);
              },
              [this](const self_awareness::SelfAwareness& alarm) {
                bag_.write(privateTopic("alarm"), now_, alarm, true);
              },
              [this] { writeDiagnostics(); }}),
      now_(start),
      heard_(moment()) {
  heard_.setTypes({types.begin(), types.begin() + static_cast<std::ptrdiff_t>(model.types)});
}

void ReplayedMonitor::onVerdict(const core::Verdict& verdict) {
  now_ = verdict.window->start + model_.window;
  alarm_.add(verdict, vocabulary_, model_.window);
  if (heard_.sinceReport(moment().steady) >= kHeartbeat) {
    writeDiagnostics();
  }
}

void ReplayedMonitor::onEvent(const core::Event& event, bool same_clock) {
  if (!same_clock) {
    steady_ahead_ += now_ - event.stamp;
    now_ = event.stamp;
    heard_.onClockStep();
    alarm_.standDown(kClockWasSet, now_);
  }
  if (vocabulary_.isMessage(event.id)) {
    heard_.add(event);
  }
}

void ReplayedMonitor::writeDiagnostics() {
  CommunicationState state;
  state.model = model_.path;
  state.calibrated = model_.calibrated;
  state.coverage = model_.coverage;
  state.take(alarm_, heard_.report(moment(), 0), now_);
  bag_.write("/diagnostics", now_, toDiagnostics(state, ResultBag::kNode, now_));
}

}  // namespace self_awareness::ros1
