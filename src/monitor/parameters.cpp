#include "parameters.h"

#include <ros/console.h>
#include <ros/param.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace self_awareness {
namespace {

/// Reads parameters of one namespace and remembers which.
class ParameterReader {
 public:
  explicit ParameterReader(const ros::NodeHandle& node_handle) : node_handle_(node_handle) {}

  template <typename T>
  T read(const std::string& name, const T& otherwise) {
    known_.insert(name);
    T value = otherwise;
    if (node_handle_.hasParam(name) && !node_handle_.getParam(name, value)) {
      throw std::invalid_argument(node_handle_.resolveName(name) + " has the wrong type");
    }
    ROS_INFO_STREAM(node_handle_.resolveName(name) << ": " << value);
    return value;
  }

  /// A number of seconds of at least `least`.
  double seconds(const std::string& name, double otherwise, double least) {
    const double value = read(name, otherwise);
    if (!std::isfinite(value) || value < least) {
      fail(name, std::to_string(value),
           "a finite number of seconds of at least " + std::to_string(least));
    }
    return value;
  }

  int wholeNumber(const std::string& name, int otherwise, int least) {
    const int value = read(name, otherwise);
    if (value < least) {
      fail(name, std::to_string(value), "a whole number of at least " + std::to_string(least));
    }
    return value;
  }

  template <typename T>
  T choice(const std::string& name, const std::string& otherwise,
           const std::vector<std::pair<std::string, T>>& choices) {
    const std::string value = read(name, otherwise);
    std::string names;
    for (const auto& [choice, meaning] : choices) {
      if (value == choice) {
        return meaning;
      }
      names += (names.empty() ? "" : ", ") + choice;
    }
    fail(name, "'" + value + "'", "one of: " + names);
  }

  /// A parameter that something else reads.
  void expect(const std::string& name) { known_.insert(name); }

  void warnOfUnknown() const {
    std::vector<std::string> names;
    ros::param::getParamNames(names);
    const std::string prefix = node_handle_.getNamespace() + "/";
    std::set<std::string> unknown;
    for (const std::string& name : names) {
      if (name.compare(0, prefix.size(), prefix) == 0) {
        const std::string own = name.substr(prefix.size());
        if (known_.count(own) == 0) {
          unknown.insert(own);
        }
      }
    }
    for (const std::string& name : unknown) {
      ROS_WARN("%s is not a parameter of self_awareness; it is ignored",
               node_handle_.resolveName(name).c_str());
    }
  }

 private:
  [[noreturn]] void fail(const std::string& name, const std::string& value,
                         const std::string& must_be) const {
    throw std::invalid_argument(node_handle_.resolveName(name) + " is " + value + ", it must be " +
                                must_be);
  }

  ros::NodeHandle node_handle_;
  std::set<std::string> known_;
};

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
