#include "parameters.h"

#include <cmath>

#include "parameter_reader.h"

namespace self_awareness {
namespace {

std::int64_t nanoseconds(double seconds) {
  return std::llround(seconds * 1e9);
}

}  // namespace

std::string MonitorParameters::loadModel(const ros::NodeHandle& private_node_handle,
                                         const std::string& otherwise) {
  return ParameterReader(private_node_handle).read("model", otherwise);
}

MonitorParameters MonitorParameters::load(const ros::NodeHandle& private_node_handle) {
  using ros1::SubscribePolicy;
  MonitorParameters parameters;
  const MonitorParameters defaults;
  const auto inSeconds = core::toSeconds;
  ParameterReader reader(private_node_handle);

  parameters.model = reader.read("model", defaults.model);
  parameters.method = reader.choice<Method>(
      "detector", "evidence", {{"evidence", Method::kEvidence}, {"paper", Method::kPaper}});
  parameters.subscribe = reader.choice<SubscribePolicy>("subscribe", "used",
                                                        {{"used", SubscribePolicy::kUsed},
                                                         {"all", SubscribePolicy::kAll},
                                                         {"model", SubscribePolicy::kModel}});
  core::Detector::Parameters& detector = parameters.detector;
  core::Persistence::Parameters& persistence = detector.persistence;
  detector.settle_time =
      nanoseconds(reader.seconds("settle_time", inSeconds(defaults.detector.settle_time), 0));
  detector.silence_is_abnormal =
      reader.choice<bool>("silence", "abnormal", {{"abnormal", true}, {"ignored", false}});
  detector.unknown = reader.choice<core::UnknownEvents>("unknown", "warn",
                                                        {{"ignore", core::UnknownEvents::kIgnore},
                                                         {"warn", core::UnknownEvents::kWarn},
                                                         {"error", core::UnknownEvents::kError}});
  persistence.alarm_windows = reader.wholeNumber("alarm_windows", persistence.alarm_windows, 1);
  persistence.alarm_of = reader.wholeNumber("alarm_of", persistence.alarm_of, 1);
  persistence.hold_time =
      nanoseconds(reader.seconds("hold_time", inSeconds(persistence.hold_time), 0));
  detector.validate();
  parameters.poll_interval = reader.seconds("poll_interval", defaults.poll_interval, 0.01);
  parameters.queue_size = static_cast<std::uint32_t>(
      reader.wholeNumber("queue_size", static_cast<int>(defaults.queue_size), 1));
  parameters.source_diagnostics = reader.read("source_diagnostics", defaults.source_diagnostics);
  parameters.hardware_id = reader.read("hardware_id", defaults.hardware_id);
  RecorderParameters& recorder = parameters.recorder;
  recorder.duration = reader.seconds("recorder/duration", recorder.duration, 0);
  recorder.after = reader.seconds("recorder/after", recorder.after, 0);
  recorder.directory = reader.read("recorder/directory", recorder.directory);
  recorder.files = reader.wholeNumber("recorder/files", recorder.files, 1);
  recorder.disk = reader.wholeNumber("recorder/disk", recorder.disk, 1);
  recorder.memory = reader.wholeNumber("recorder/memory", recorder.memory, 1);
  reader.expect("diagnostic_period");  // of diagnostic_updater
  reader.warnOfUnknown();
  return parameters;
}

}  // namespace self_awareness
