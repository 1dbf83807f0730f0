#pragma once

#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/param.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace self_awareness {

/// Reads parameters of one namespace, logs them, and remembers which. All functions that read
/// throw std::invalid_argument, which names the parameter, its value and what it may be.
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
    return atLeast(name, otherwise, least, "seconds");
  }

  /// A number of at least `least`, of a unit.
  double atLeast(const std::string& name, double otherwise, double least,
                 const std::string& unit) {
    const double value = read(name, otherwise);
    if (!std::isfinite(value) || value < least) {
      fail(name, std::to_string(value),
           "a finite number of " + unit + " of at least " + std::to_string(least));
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
        const std::string top = own.substr(0, own.find('/'));
        if (known_.count(own) == 0 && known_.count(top) == 0) {
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

}  // namespace self_awareness
