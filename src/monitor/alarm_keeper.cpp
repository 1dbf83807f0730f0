#include "alarm_keeper.h"

#include <ros/console.h>

#include <exception>
#include <utility>

#include "diagnostics.h"
#include "ros/verdict/kept_files.h"
#include "self_awareness/ros/ros_time.h"
#include "session.h"

namespace self_awareness {

AlarmKeeper::AlarmKeeper(RecorderFolder folder, std::string run_id)
    : folder_(std::move(folder)),
      path_(folder_.pathOfStandingAlarm()),
      run_id_(std::move(run_id)) {}

void AlarmKeeper::setModel(std::uint64_t content) {
  model_ = content;
  if (read_) {  // what stood of the old model, or before there was one, is known no more
    keep({}, 0, "");
  }
}

void AlarmKeeper::onStart(const Session& session, const std::string& /*path*/) {
  setModel(session.content());
}

void AlarmKeeper::onAlarm(const ros1::AlarmState& alarm) {
  keep(alarm.message(), alarm.since(), alarm.recording());
}

void AlarmKeeper::onReport(MonitorState& state) {
  state.keeper_error = error();
}

std::optional<self_awareness::StandingAlarm> AlarmKeeper::read() {
  read_ = true;
  try {
    std::optional<self_awareness::StandingAlarm> standing = ros1::readStandingAlarm(path_);
    if (standing && standing->run_id == run_id_) {
      stands_ = true;
      if (standing->model == 0 || standing->model == model_) {
        return standing;
      }
      ROS_WARN("%s: another model judged when this alarm was raised: it does not stand any more",
               path_.c_str());
    }
  } catch (const std::exception& error) {
    ROS_ERROR("%s; whether an alarm stood is not known", error.what());
  }
  return std::nullopt;
}

void AlarmKeeper::keep(const self_awareness::SelfAwareness& alarm, std::int64_t since,
                       const std::string& recording) {
  const bool stands = alarm.level == self_awareness::SelfAwareness::ERROR;
  if (!std::exchange(stands_, stands) && !stands) {
    return;
  }
  self_awareness::StandingAlarm standing;
  standing.run_id = run_id_;
  standing.model = model_;
  standing.since = ros1::toRosTime(since);
  standing.recording = recording;
  standing.alarm = alarm;
  writer_.add({path_, 0, [folder = folder_, standing](const std::string& path) {
                 folder.create();
                 ros1::writeStandingAlarm(standing, path);
               }});
}

}  // namespace self_awareness
