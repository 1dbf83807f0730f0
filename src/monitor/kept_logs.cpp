#include "kept_logs.h"

#include <algorithm>
#include <boost/filesystem.hpp>
#include <limits>
#include <utility>

#include "diagnostics.h"
#include "recorder_folder.h"
#include "self_awareness/ros/ros_time.h"
#include "session.h"

namespace self_awareness {
namespace {

namespace filesystem = boost::filesystem;

constexpr char kBeside[] = ".kept";

}  // namespace

KeptLogs::KeptLogs(const KeptLogsParameters& parameters, std::function<ros1::LogSource()> source,
                   std::int64_t robot_start)
    : parameters_(parameters), source_(std::move(source)), robot_start_(robot_start) {}

void KeptLogs::setModel(const std::string& path, bool calibrated) {
  lasting_.forget();
  folder_ = enabled() && calibrated ? filesystem::absolute(path).string() + kBeside : "";
}

void KeptLogs::onStart(const Session& session, const std::string& path) {
  setModel(path, session.calibrated());
}

void KeptLogs::onEvent(const core::Event& event, const core::Vocabulary& vocabulary) {
  if (folder_.empty() || finished_) {
    return;
  }
  if (!packer_) {
    packer_.emplace([this](self_awareness::EventLog part) {
      bytes_ += ros1::bytesOf(part);
      parts_.push_back(std::make_shared<const self_awareness::EventLog>(std::move(part)));
    });
    first_ = event.stamp;
    last_ = event.stamp;
    for (const core::Event& lasting : lasting_.at(first_)) {
      packer_->add(lasting, vocabulary);
    }
  }
  lasting_.add(event, vocabulary);
  last_ = std::max(last_, event.stamp);
  if (why_.empty()) {  // else nobody will read it
    packer_->add(event, vocabulary);
  }
}

void KeptLogs::onWaiting(const core::Waiting& waiting) {
  if (packer_ && why_.empty()) {
    packer_->add(waiting);
  }
}

void KeptLogs::onTick(const Moment& now) {
  if (!packer_) {
    return;
  }
  last_ = std::max(last_, now.heard_until);
  packer_->advance(last_);
  if (last_ - first_ >= kLongest || bytes_ >= kMostBytes) {
    endStretch();
  }
}

void KeptLogs::leaveOut(const std::string& why) {
  if (packer_ && why_.empty()) {
    why_ = why;
    parts_.clear();
    bytes_ = 0;
  }
}

void KeptLogs::endStretch() {
  if (!packer_) {
    return;
  }
  if (!why_.empty()) {
    ++report_.left_out;
    report_.why = why_;
  } else if (last_ - first_ >= kShortest) {
    write();
  }
  packer_.reset();
  parts_.clear();
  bytes_ = 0;
  why_.clear();
}

void KeptLogs::write() {
  packer_->flush(last_);
  const ros1::LogSource source = source_();
  ros1::RecordedLog log;
  log.start = ros1::startOfRecording(source.encoding, first_, robot_start_);
  log.graph = source.graph;
  log.parts = parts_;
  ++report_.kept;
  named_at_ = std::max(ros1::wallNow(), named_at_ + kNameStep);
  writer_.add(
      {folder_ + "/normal_" + timeInFileName(named_at_) + ".bag", bytes_,
       [log = std::move(log), folder = folder_,
        most = static_cast<std::uint64_t>(parameters_.disk) * kMegabyte](const std::string& file) {
         filesystem::create_directories(folder);
         ros1::writeLog(log, file);
         removeOldest(folder, "normal_([-0-9.]+)\\.bag", std::numeric_limits<std::size_t>::max(),
                      most);
       }});
}

void KeptLogs::onRobotStart(std::int64_t at) {
  endStretch();
  lasting_.forget();
  robot_start_ = at;
}

void KeptLogs::finish() {
  if (!std::exchange(finished_, true)) {
    endStretch();
    writer_.finish();
  }
}

void KeptLogs::onReport(MonitorState& state) {
  if (enabled()) {
    state.kept_logs = report();
  }
}

KeptLogs::Report KeptLogs::report() const {
  Report report = report_;
  report.files = writer_.report();
  return report;
}

}  // namespace self_awareness
