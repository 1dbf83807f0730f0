#pragma once

#include <ros/node_handle.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace self_awareness {

/// Reads parameters of one namespace, logs them, and remembers which. All functions that read
/// throw std::invalid_argument, which names the parameter, its value and what it may be.
class ParameterReader {
 public:
  /// What a number may be, both ends included.
  struct Range {
    double least;
    double most;
  };

  explicit ParameterReader(const ros::NodeHandle& node_handle) : node_handle_(node_handle) {}

  /// @param must_be in words
  std::string text(const std::string& name, const std::string& otherwise,
                   const std::string& must_be = "text");
  bool flag(const std::string& name, bool otherwise);
  /// @param unit in words, as in "a number of seconds"
  double number(const std::string& name, double otherwise, const Range& range,
                const std::string& unit);
  double seconds(const std::string& name, double otherwise, const Range& range) {
    return number(name, otherwise, range, "seconds");
  }
  int wholeNumber(const std::string& name, int otherwise, const Range& range);

  /// A list of names, each of a node or a topic, or the begin of one and a `*`; none by default.
  std::vector<std::string> names(const std::string& name);

  template <typename T>
  T choice(const std::string& name, const std::string& otherwise,
           const std::vector<std::pair<std::string, T>>& choices) {
    std::string names;
    for (const auto& [choice, meaning] : choices) {
      names += (names.empty() ? "one of: " : ", ") + choice;
    }
    const std::string value = text(name, otherwise, names);
    for (const auto& [choice, meaning] : choices) {
      if (value == choice) {
        return meaning;
      }
    }
    fail(name, value, names);
  }

  /// A namespace that something else reads.
  void expectNamespace(const std::string& name) { spaces_.insert(name); }
  void warnOfUnknown() const;

 private:
  /// A value of one kind.
  template <typename T>
  T read(const std::string& name, T otherwise, XmlRpc::XmlRpcValue::Type type,
         const std::string& must_be);
  /// A number of either kind, as XML-RPC has them.
  double readNumber(const std::string& name, double otherwise, const std::string& must_be);
  template <typename T>
  void log(const std::string& name, const T& value) const;
  [[noreturn]] void fail(const std::string& name, const XmlRpc::XmlRpcValue& value,
                         const std::string& must_be) const;

  ros::NodeHandle node_handle_;
  std::set<std::string> known_;
  std::set<std::string> spaces_;
};

}  // namespace self_awareness
