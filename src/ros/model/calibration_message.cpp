#include "self_awareness/ros/model/calibration_message.h"

#include <algorithm>
#include <cmath>

#include "check.h"
#include "self_awareness/ros/model/evidence_message.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

// Of evidence, in any unit: no method finds others.
constexpr double kLeastLimit = 1e-9;
constexpr double kLargestLimit = 1e12;

bool isNoRate(double value) {
  return !(value >= 0 && std::isfinite(value)) && !std::isnan(value);
}

bool isNoShare(double value) {
  return !(value >= 0 && value <= 1) && !std::isnan(value);
}

}  // namespace

std::vector<self_awareness::Recording> toMessages(
    const std::vector<core::RecordingInfo>& recordings) {
  std::vector<self_awareness::Recording> messages;
  for (const core::RecordingInfo& recording : recordings) {
    self_awareness::Recording& message = messages.emplace_back();
    message.bag = recording.bag;
    message.start = toRosTime(recording.start);
    message.end = toRosTime(std::max(recording.start, recording.end));
    message.events = recording.events;
    message.robot_start = toRosTime(recording.robot_start);
    message.robot = recording.robot;
    message.fingerprint = recording.fingerprint;
  }
  return messages;
}

std::vector<core::RecordingInfo> fromMessages(
    const std::vector<self_awareness::Recording>& messages) {
  std::vector<core::RecordingInfo> recordings;
  for (const self_awareness::Recording& message : messages) {
    check(message.start <= message.end, "a recording of it ends before it starts");
    recordings.push_back({message.bag, fromRosTime(message.start), fromRosTime(message.end),
                          message.events, fromRosTime(message.robot_start), message.fingerprint,
                          message.robot});
  }
  return recordings;
}

self_awareness::EvidenceCalibration toMessage(const core::Calibration& calibration) {
  self_awareness::EvidenceCalibration message;
  message.method = calibration.method;
  message.limits = calibration.limits.tracks;
  message.firsts = calibration.limits.firsts;
  for (const core::evidence::Relation& relation : calibration.relations) {
    message.relations.push_back(toMessage(relation));
  }
  message.budget = calibration.budget;
  message.false_alarms_per_hour = calibration.false_alarms_per_hour;
  message.windows = calibration.windows;
  message.recordings = toMessages(calibration.recordings);
  message.stamp = toRosTime(calibration.stamp);
  return message;
}

core::Calibration fromMessage(const self_awareness::EvidenceCalibration& message,
                              std::size_t tracks, std::size_t types) {
  check(message.limits.size() == tracks,
        "its limits are not those of its evidence; calibrate it again");
  // NaN: the track is not judged.
  check(std::none_of(message.limits.begin(), message.limits.end(),
                     [](double limit) { return limit < kLeastLimit || limit > kLargestLimit; }),
        "a limit of its evidence cannot be");
  check(tracks == 0 || std::any_of(message.limits.begin(), message.limits.end(),
                                   [](double limit) { return limit > 0; }),
        "its limits judge nothing; calibrate it again");
  check(message.relations.empty() || message.relations.size() == tracks,
        "its relations are not those of its evidence");
  check((message.firsts.empty() || message.firsts.size() == types) && areTimes(message.firsts, -1),
        "its first events are not those of its event types");
  check(!isNoRate(message.budget) && !isNoRate(message.false_alarms_per_hour),
        "a rate of its false alarms cannot be");
  core::Calibration calibration;
  calibration.method = message.method;
  calibration.limits = {message.limits, message.firsts};
  for (const self_awareness::Relation& relation : message.relations) {
    calibration.relations.push_back(fromMessage(relation));
  }
  calibration.budget = message.budget;
  calibration.false_alarms_per_hour = message.false_alarms_per_hour;
  calibration.windows = message.windows;
  calibration.recordings = fromMessages(message.recordings);
  calibration.stamp = fromRosTime(message.stamp);
  return calibration;
}

self_awareness::Calibration toMessage(const core::paper::Calibration& calibration) {
  self_awareness::Calibration message;
  message.threshold = calibration.threshold;
  message.method = calibration.method;
  message.auc = calibration.auc;
  message.true_positive_rate = calibration.true_positive_rate;
  message.false_positive_rate = calibration.false_positive_rate;
  message.normal_windows = calibration.normal_windows;
  message.faulty_windows = calibration.faulty_windows;
  message.false_alarms_per_hour = calibration.false_alarms_per_hour;
  message.normal = toMessages(calibration.normal);
  message.faulty = toMessages(calibration.faulty);
  message.injected = calibration.injected;
  message.stamp = toRosTime(calibration.stamp);
  return message;
}

core::paper::Calibration fromMessage(const self_awareness::Calibration& message) {
  check(std::isfinite(message.threshold), "its threshold is not a finite number");
  check(!isNoShare(message.auc) && !isNoShare(message.true_positive_rate) &&
            !isNoShare(message.false_positive_rate) && !isNoRate(message.false_alarms_per_hour),
        "a rate of its calibration cannot be");
  core::paper::Calibration calibration;
  calibration.threshold = message.threshold;
  calibration.method = message.method;
  calibration.auc = message.auc;
  calibration.true_positive_rate = message.true_positive_rate;
  calibration.false_positive_rate = message.false_positive_rate;
  calibration.normal_windows = message.normal_windows;
  calibration.faulty_windows = message.faulty_windows;
  calibration.false_alarms_per_hour = message.false_alarms_per_hour;
  calibration.normal = fromMessages(message.normal);
  calibration.faulty = fromMessages(message.faulty);
  calibration.injected = message.injected;
  calibration.stamp = fromRosTime(message.stamp);
  return calibration;
}

}  // namespace self_awareness::ros1
