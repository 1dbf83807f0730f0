#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <tuple>

#include "name_patterns.h"
#include "self_awareness/core/stream/mode.h"
#include "self_awareness/ros/encoding.h"
#include "text.h"

namespace self_awareness::ros1 {
namespace {

/// @throw std::invalid_argument if the classes of a datatype cannot be
void checkClasses(const EncodingRules& rules, const std::string& datatype,
                  const ValueClasses& classes) {
  const std::string begin =
      "encoding: the classes of " + printable(datatype, kLongestQuote) + " must be ";
  if (rules.type_fields.count(datatype) == 0) {
    throw std::invalid_argument(begin + "those of one of its fields (type_fields)");
  }
  if (classes.number < ValueClasses::kFewest || classes.number > ValueClasses::kMost) {
    throw std::invalid_argument(begin + std::to_string(ValueClasses::kFewest) + " to " +
                                std::to_string(ValueClasses::kMost) + ", not " +
                                std::to_string(classes.number));
  }
  const std::vector<double>& bounds = classes.bounds;
  if (bounds.size() >= classes.number ||
      !std::all_of(bounds.begin(), bounds.end(),
                   [](double bound) { return std::isfinite(bound); }) ||
      std::adjacent_find(bounds.begin(), bounds.end(), std::greater_equal<>()) != bounds.end()) {
    throw std::invalid_argument(begin +
                                "separated by finite, ascending bounds, fewer than classes");
  }
}

/// With as few digits as tell it from all other numbers.
std::string inShort(double value) {
  char text[32];
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) {
      break;
    }
  }
  return text;
}

/// @throw std::invalid_argument if the mode that is there cannot be told
void checkMode(const EncodingRules& rules) {
  const ModeField& mode = *rules.mode;
  const std::string begin = "encoding: the mode is told on " + quote(mode.topic);
  if (!isPrintable(mode.topic) || !whyLeftOut(mode.topic).empty() || mode.topic[0] != '/') {
    throw std::invalid_argument(begin +
                                ", which is not the name of a topic; it begins with a slash");
  }
  if (!isPrintable(mode.field) || mode.field.empty()) {
    throw std::invalid_argument(begin + ", but no field is named; name one of its messages");
  }
  const NamePatterns include(rules.include_topics);
  if ((!include.empty() && !include.match(mode.topic)) ||
      NamePatterns(rules.exclude_topics).match(mode.topic)) {
    throw std::invalid_argument(begin +
                                ", which include_topics or exclude_topics leave out; let it in");
  }
}

}  // namespace

EncodingRules EncodingRules::defaults() {
  EncodingRules rules;
  rules.exclude_topics = {"/clock",
                          "/rosout_agg",
                          "/statistics",
                          "/diagnostics_agg",
                          "/diagnostics_toplevel_state",
                          ".*/bond",
                          ".*/self_awareness/(status|alarm)"};
  rules.exclude_sources = {".*/self_awareness(_manager)?", "(.*/)?(play|record|recorder|rosbag.*)",
                           "(.*/)?(rqt|rviz|rosnode|rosservice|plotjuggler|foxglove).*"};
  rules.type_fields = {{"actionlib_msgs/GoalStatus", "status"},
                       {"diagnostic_msgs/DiagnosticArray", "status.level"},
                       {"rosgraph_msgs/Log", "level"},
                       {"sensor_msgs/JointState", "name"},
                       {"tf/tfMessage", "transforms.child_frame_id"},
                       {"tf2_msgs/TFMessage", "transforms.child_frame_id"},
                       {"visualization_msgs/Marker", "action"}};
  return rules;
}

void EncodingRules::validate() const {
  const NameRenames checked(renames);
  for (const auto* patterns :
       {&include_topics, &exclude_topics, &include_sources, &exclude_sources}) {
    const NamePatterns each(*patterns);
  }
  for (const auto& [datatype, field] : type_fields) {
    if (!isPrintable(datatype) || !isPrintable(field)) {
      throw std::invalid_argument("encoding: the type field " + quote(datatype + ": " + field) +
                                  " is no UTF-8, or has control characters");
    }
  }
  for (const auto& [datatype, its] : classes) {
    checkClasses(*this, datatype, its);
  }
  if (mode) {
    checkMode(*this);
  }
}

std::vector<std::string> namesOfClasses(const std::vector<double>& bounds) {
  std::vector<std::string> names{"below " + inShort(bounds.front())};
  for (std::size_t k = 0; k + 1 < bounds.size(); ++k) {
    names.push_back(inShort(bounds[k]) + " to " + inShort(bounds[k + 1]));
  }
  names.push_back(inShort(bounds.back()) + " or more");
  names.emplace_back("NaN");
  return names;
}

std::size_t classOf(double value, const std::vector<double>& bounds) {
  const auto next = std::upper_bound(bounds.begin(), bounds.end(), value);
  return std::isnan(value) ? bounds.size() + 1 : static_cast<std::size_t>(next - bounds.begin());
}

bool operator==(const EncodingRules& a, const EncodingRules& b) {
  const auto fields = [](const EncodingRules& rules) {
    return std::tie(rules.source, rules.renames, rules.include_topics, rules.exclude_topics,
                    rules.include_sources, rules.exclude_sources, rules.type_fields, rules.classes,
                    rules.mode);
  };
  return fields(a) == fields(b);
}

void checkEventTypes(const EncodingRules& rules, const core::Vocabulary& vocabulary) {
  std::map<std::string, std::size_t> types;  // by datatype
  std::size_t modes = 0;
  for (const core::EventType& type : vocabulary.types()) {
    if (core::tellsMode(type) && ++modes > kMostTypesOfField) {
      throw std::invalid_argument(
          "the field of the mode (" +
          (rules.mode ? rules.mode->topic + ": " + rules.mode->field : std::string("not known")) +
          ") has more than " + std::to_string(kMostTypesOfField) +
          " values; name a field that says what the robot does");
    }
    const std::size_t datatype_end = type.type.find('[');
    const std::size_t field_end = type.type.find('=', datatype_end);
    if (field_end == std::string::npos) {
      continue;
    }
    const std::string datatype = type.type.substr(0, datatype_end);
    if (++types[datatype] > kMostTypesOfField) {
      const std::string field = type.type.substr(datatype_end + 1, field_end - datatype_end - 1);
      throw std::invalid_argument("the type field " + datatype + ": " + field + " has more than " +
                                  std::to_string(kMostTypesOfField) +
                                  " values; name a field that says what a message does, or none "
                                  "for this datatype");
    }
  }
  if (vocabulary.size() > kMostEventTypes) {
    throw std::invalid_argument("there are more than " + std::to_string(kMostEventTypes) +
                                " event types; leave topics or nodes out by the encoding");
  }
}

}  // namespace self_awareness::ros1
