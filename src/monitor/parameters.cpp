#include "parameters.h"

#include <ros/param.h>

#include "node/parameter_reader.h"

namespace self_awareness {

// Longer than any of these times is of use; and they are added up in nanoseconds.
constexpr double kHour = 3600;  // [s]
constexpr double kDay = 86400;  // [s]

std::string MonitorParameters::loadModel(const ros::NodeHandle& private_node_handle,
                                         const std::string& otherwise) {
  return ParameterReader(private_node_handle).text("model", otherwise);
}

MonitorParameters MonitorParameters::load(const ros::NodeHandle& private_node_handle) {
  using ros1::SubscribePolicy;
  MonitorParameters parameters;
  const MonitorParameters defaults;
  const auto inSeconds = core::toSeconds;
  ParameterReader reader(private_node_handle);

  parameters.model = reader.text("model", defaults.model);
  parameters.method = reader.choice<Method>(
      "detector", "evidence", {{"evidence", Method::kEvidence}, {"paper", Method::kPaper}});
  parameters.live.subscribe = reader.choice<SubscribePolicy>("subscribe", "used",
                                                             {{"used", SubscribePolicy::kUsed},
                                                              {"all", SubscribePolicy::kAll},
                                                              {"model", SubscribePolicy::kModel}});
  core::Detector::Parameters& detector = parameters.detector;
  core::Persistence::Parameters& persistence = detector.persistence;
  detector.settle_time = core::toNanoseconds(
      reader.seconds("settle_time", inSeconds(defaults.detector.settle_time), {0, kHour}));
  detector.silence_is_abnormal =
      reader.choice<bool>("silence", "abnormal", {{"abnormal", true}, {"ignored", false}});
  detector.unknown = reader.choice<core::UnknownEvents>("unknown", "warn",
                                                        {{"ignore", core::UnknownEvents::kIgnore},
                                                         {"warn", core::UnknownEvents::kWarn},
                                                         {"error", core::UnknownEvents::kError}});
  persistence.alarm_of = reader.wholeNumber("alarm_of", persistence.alarm_of, {1, 1000});
  const double alarm_of = persistence.alarm_of;
  persistence.alarm_windows =
      reader.wholeNumber("alarm_windows", persistence.alarm_windows, {1, alarm_of});
  persistence.hold_time = core::toNanoseconds(
      reader.seconds("hold_time", inSeconds(persistence.hold_time), {0, kHour}));
  parameters.optional = reader.names("optional");
  parameters.live.poll_interval =
      reader.seconds("poll_interval", defaults.live.poll_interval, {0.01, kHour});
  parameters.live.queue_size = static_cast<std::uint32_t>(
      reader.wholeNumber("queue_size", static_cast<int>(defaults.live.queue_size), {1, 1000000}));
  parameters.source_diagnostics = reader.flag("source_diagnostics", defaults.source_diagnostics);
  parameters.hardware_id = reader.text("hardware_id", defaults.hardware_id);
  RecorderParameters& recorder = parameters.recorder;
  recorder.name = private_node_handle.getNamespace();
  recorder.duration = reader.seconds("recorder/duration", recorder.duration, {0, kDay});
  recorder.after = reader.seconds("recorder/after", recorder.after, {0, kHour});
  recorder.directory = reader.text("recorder/directory", recorder.directory);
  recorder.files = reader.wholeNumber("recorder/files", recorder.files, {1, 100000});
  recorder.disk = reader.wholeNumber("recorder/disk", recorder.disk, {1, 1000000});
  recorder.memory = reader.wholeNumber("recorder/memory", recorder.memory, {1, 10000});
  KeptLogsParameters& kept_logs = parameters.kept_logs;
  kept_logs.on = reader.flag("learn_more", kept_logs.on);
  kept_logs.disk = reader.wholeNumber("learn_more_disk", kept_logs.disk, {1, 1000000});
  parameters.live.diagnostic_period =
      reader.seconds("diagnostic_period", defaults.live.diagnostic_period, {0.1, kHour});
  parameters.diagnostic_bytes = static_cast<std::size_t>(reader.wholeNumber(
      "diagnostic_bytes", static_cast<int>(defaults.diagnostic_bytes), {100, 10000000}));
  ros::param::get("/run_id", parameters.run_id);
  reader.warnOfUnknown();
  return parameters;
}

}  // namespace self_awareness
