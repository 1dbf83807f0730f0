#include "flight_recorder.h"

#include <algorithm>
#include <utility>

#include "diagnostics.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness {

RecorderFolder folderOf(const RecorderParameters& parameters) {
  return {parameters.directory, parameters.name, static_cast<std::size_t>(parameters.files),
          static_cast<std::uint64_t>(parameters.disk) * kMegabyte};
}

FlightRecorder::FlightRecorder(const RecorderParameters& parameters,
                               std::function<ros1::LogSource()> source)
    : duration_(core::toNanoseconds(parameters.duration)),
      after_(core::toNanoseconds(parameters.after)),
      most_bytes_(static_cast<std::size_t>(parameters.memory) * kMegabyte),
      source_(std::move(source)),
      folder_(folderOf(parameters)),
      packer_([this](self_awareness::EventLog part) { keep(std::move(part)); }) {}

std::vector<ros::ServiceServer> FlightRecorder::advertise(ros::NodeHandle& private_node_handle) {
  return {private_node_handle.advertiseService("dump", &FlightRecorder::onDump, this)};
}

void FlightRecorder::onEvent(const core::Event& event, const core::Vocabulary& vocabulary) {
  if (!enabled()) {
    return;
  }
  if (!first_) {
    first_ = event.stamp;
    last_ = event.stamp;
  }
  last_ = std::max(last_, event.stamp);
  packer_.add(event, vocabulary);
}

void FlightRecorder::onWaiting(const core::Waiting& waiting) {
  if (heardAnything()) {
    packer_.add(waiting);
  }
}

void FlightRecorder::onTick(const Moment& now) {
  now_ = now.steady;
  if (heardAnything()) {
    last_ = std::max(last_, now.heard_until);
    packer_.advance(last_);
  }
  if (pending_ && now_ >= pending_->due) {
    write(std::exchange(pending_, std::nullopt)->path);
  }
}

void FlightRecorder::onCut(Cut /*why*/) {
  if (pending_) {
    write(std::exchange(pending_, std::nullopt)->path);
  }
  packer_ = ros1::EventLogPacker([this](self_awareness::EventLog part) { keep(std::move(part)); });
  parts_.clear();
  bytes_ = 0;
  first_.reset();
  forgotten_types_.clear();
}

void FlightRecorder::onVerdict(core::Verdict& verdict, ros1::Circumstances& circumstances) {
  if (verdict.alarm && !stands_ && enabled()) {
    if (!pending_) {
      pending_ = Pending{newPath("alarm"), now_ + after_};
    }
    kept_ = pending_->path;
  }
  if (verdict.alarm) {
    circumstances.recording = kept_;
  }
}

void FlightRecorder::onAlarm(const ros1::AlarmState& alarm) {
  stands_ = alarm.message().level == self_awareness::SelfAwareness::ERROR;
  kept_ = stands_ ? alarm.recording() : "";
}

void FlightRecorder::onReport(MonitorState& state) {
  if (enabled()) {
    state.recorder = report();
  }
}

bool FlightRecorder::onDump(std_srvs::Trigger::Request& /*request*/,
                            std_srvs::Trigger::Response& response) {
  const std::optional<std::string> path = dump();
  const Report now = report();
  response.success = path && now.files.error.empty();
  if (!enabled()) {
    response.message = "there is no flight recorder: ~recorder/duration is 0";
  } else if (!path) {
    response.message = "nothing was heard yet";
  } else if (!now.files.error.empty()) {
    response.message = now.files.error + "; it is tried again";
  } else {
    response.message = "the last " + ros1::number(now.seconds) + " s go to " + *path;
  }
  return true;
}

std::optional<std::string> FlightRecorder::dump() {
  if (!heardAnything()) {
    return std::nullopt;
  }
  std::string dumped = newPath("dump");
  write(dumped);
  return dumped;
}

void FlightRecorder::finish() {
  if (std::exchange(finished_, true)) {
    return;
  }
  if (pending_) {
    write(std::exchange(pending_, std::nullopt)->path);
  } else if (stands_ && heardAnything()) {
    write(newPath("shutdown"));
  }
  writer_.finish();
}

FlightRecorder::Report FlightRecorder::report() const {
  Report report;
  report.seconds = first_ ? core::toSeconds(last_ - *first_) : 0;
  report.files = writer_.report();
  report.bytes = bytes_ + report.files.waiting_bytes;
  return report;
}

void FlightRecorder::keep(self_awareness::EventLog part) {
  bytes_ += ros1::bytesOf(part);
  parts_.push_back(std::make_shared<const self_awareness::EventLog>(std::move(part)));
  while (parts_.size() > 1 &&
         (bytes_ > most_bytes_ ||
          static_cast<std::int64_t>(parts_.front()->heard_until.toNSec()) < last_ - duration_)) {
    forgetOldest();
  }
}

void FlightRecorder::forgetOldest() {
  const self_awareness::EventLog& oldest = *parts_.front();
  // The parts after it name event types by their numbers.
  forgotten_types_.insert(forgotten_types_.end(), oldest.new_types.begin(),
                          oldest.new_types.end());
  first_ = static_cast<std::int64_t>(oldest.heard_until.toNSec());
  bytes_ -= ros1::bytesOf(oldest);
  parts_.pop_front();
}

std::string FlightRecorder::newPath(const std::string& cause) {
  named_at_ = std::max(ros1::wallNow(), named_at_ + kNameStep);
  return folder_.pathOf(cause, named_at_);
}

void FlightRecorder::write(const std::string& path) {
  packer_.flush(last_);
  const ros1::LogSource source = source_();
  ros1::RecordedLog recording;
  recording.start = ros1::startOfRecording(source.encoding, *first_);
  recording.graph = source.graph;
  recording.types_before = forgotten_types_;
  recording.parts.assign(parts_.begin(), parts_.end());
  const RecorderFolder folder = folder_;
  writer_.add({path, bytes_, [folder, recording, kept = kept_](const std::string& file) {
                 folder.create();
                 ros1::writeLog(recording, file);
                 folder.makeRoom(kept);
               }});
}

}  // namespace self_awareness
