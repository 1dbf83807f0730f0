#include "self_awareness/ros/encoding.h"

#include <ros/names.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "message_definition.h"
#include "name_patterns.h"
#include "name_renames.h"
#include "self_awareness/core/stream/latched.h"
#include "self_awareness/core/stream/mode.h"
#include "self_awareness/ros/siblings.h"
#include "self_awareness/ros/stable_name.h"
#include "text.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::size_t kLongestQuote = 100;  // [bytes]

/// Whether a node is `rostopic pub`, in any namespace.
bool isRostopic(const std::string& source) {
  return source.substr(source.rfind('/') + 1) == "rostopic";
}

std::string headerField(const ros::M_string& header, const std::string& name) {
  const auto field = header.find(name);
  return field == header.end() ? "" : field->second;
}

/// roscpp throws an exception at names that rospy only warns of, or that a bag brings along.
bool isLegalTopic(const std::string& name) {
  std::string error;
  return !name.empty() && name.size() <= kLongestName && ros::names::validate(name, error) &&
         name[0] != '~';
}

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

/// The field by which the messages of a connection say what they do: that of their type, or that
/// of a type which one of their own fields has, as the results of actions have a status of their
/// goal. Empty: none does.
std::string typeFieldOf(const EncodingRules& rules, const Connection& connection) {
  const auto own = rules.type_fields.find(connection.datatype);
  if (own != rules.type_fields.end()) {
    return own->second;
  }
  try {
    const MessageDefinition definition(connection.definition, connection.datatype);
    for (const MessageDefinition::Line& line : definition.linesOf(connection.datatype)) {
      const auto field = rules.type_fields.find(line.type);
      const bool has_classes = rules.classes.count(line.type) > 0;  // of messages of that type
      if (field != rules.type_fields.end() && line.array.empty() && !has_classes) {
        const std::string path = line.name + "." + field->second;
        definition.field(path);
        return path;
      }
    }
  } catch (const std::invalid_argument&) {
    // It cannot be read, and nobody asked for it.
  }
  return "";
}

/// @throw std::invalid_argument if the mode that is there cannot be told
void checkMode(const EncodingRules& rules) {
  const ModeField& mode = *rules.mode;
  const std::string begin =
      "encoding: the mode is told on '" + printable(mode.topic, kLongestQuote) + "'";
  if (!isPrintable(mode.topic) || !isLegalTopic(mode.topic) || mode.topic[0] != '/') {
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
                       {"rosgraph_msgs/Log", "level"},
                       {"visualization_msgs/Marker", "action"}};
  return rules;
}

void EncodingRules::validate() const {
  NameRenames{renames};
  for (const auto* patterns :
       {&include_topics, &exclude_topics, &include_sources, &exclude_sources}) {
    NamePatterns{*patterns};
  }
  for (const auto& [datatype, field] : type_fields) {
    if (!isPrintable(datatype) || !isPrintable(field)) {
      throw std::invalid_argument("encoding: the type field '" +
                                  printable(datatype + ": " + field, kLongestQuote) +
                                  "' is no UTF-8, or has control characters");
    }
  }
  for (const auto& [datatype, its] : classes) {
    checkClasses(*this, datatype, its);
  }
  if (mode) {
    checkMode(*this);
  }
}

bool operator==(const ValueClasses& a, const ValueClasses& b) {
  return a.number == b.number && a.bounds == b.bounds;
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

bool operator==(const Rename& a, const Rename& b) {
  return a.pattern == b.pattern && a.name == b.name;
}

bool operator==(const ModeField& a, const ModeField& b) {
  return a.topic == b.topic && a.field == b.field;
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

core::EventId internUpTo(std::size_t most, const core::EventType& type,
                         core::Vocabulary& vocabulary) {
  if (vocabulary.size() >= most && !vocabulary.find(type)) {
    return vocabulary.intern({"", "(further topics)", "(further unknown events)"});
  }
  return vocabulary.intern(type);
}

std::string whyLeftOut(const std::string& topic) {
  return isLegalTopic(topic) ? ""
                             : "no node can subscribe to the topic '" +
                                   printable(topic, kLongestQuote) + "': its name is illegal";
}

std::string whyLeftOut(const Connection& connection) {
  for (const std::string* name : {&connection.callerid, &connection.datatype}) {
    if (name->size() > kLongestName && isLegalTopic(connection.topic)) {
      return "the name '" + printable(*name, kLongestQuote) + "...' on the topic " +
             printable(connection.topic, kLongestQuote) + " is too long";
    }
  }
  const core::EventType made_up{"", "", connection.datatype};
  if (core::tellsMode(made_up) || core::isLatched(made_up)) {  // nobody else makes them up
    return "the name '" + printable(connection.datatype, kLongestQuote) + "' on the topic " +
           printable(connection.topic, kLongestQuote) + " is no name of a type";
  }
  return whyLeftOut(connection.topic);
}

Connection connectionFrom(const ros::M_string& header, const std::string& topic) {
  Connection connection;
  // Who records may have been given a relative name; the publisher says the whole one.
  const std::string said = headerField(header, "topic");
  const bool relative = !topic.empty() && topic[0] != '/' && !said.empty();
  connection.callerid = resolvedName(printable(headerField(header, "callerid")));
  connection.topic = resolvedName(printable(relative ? said : topic));
  connection.datatype = printable(headerField(header, "type"));
  connection.md5sum = printable(headerField(header, "md5sum"));
  connection.definition = headerField(header, "message_definition");
  connection.latching = headerField(header, "latching") == "1";
  return connection;
}

bool ConnectionEncoder::accept() {
  const bool accepted = !skip_next_;
  skip_next_ = false;
  return accepted;
}

std::optional<core::EventId> ConnectionEncoder::latched() {
  if (type_.type == "rosgraph_msgs/Log") {
    return std::nullopt;
  }
  return ids_({type_.source, type_.scope, core::typeOfLatched(type_.type)});
}

core::EventId ConnectionEncoder::id() {
  if (!id_) {
    id_ = ids_(type_);
  }
  return *id_;
}

core::EventId ConnectionEncoder::id(const std::uint8_t* data, std::size_t size) {
  if (!field_) {
    return id();
  }
  const std::string found = bounds_.empty()
                                ? field_->read(data, size)
                                : class_names_[classOf(field_->number(data, size), bounds_)];
  return idByValue(found, ids_by_value_, [this](const std::string& value) {
    return type_.type + "[" + field_name_ + "=" + value + "]";
  });
}

core::EventId ConnectionEncoder::mode(const std::uint8_t* data, std::size_t size) {
  return idByValue(mode_field_->read(data, size), ids_by_mode_, [this](const std::string& value) {
    return core::typeOfMode(type_.type, value);
  });
}

template <typename TypeOf>
core::EventId ConnectionEncoder::idByValue(const std::string& value, Known& known,
                                           const TypeOf& typeOf) {
  const auto place = known.find(value);
  if (place != known.end()) {
    return place->second;
  }
  core::EventType type = type_;
  type.type = typeOf(value);
  const core::EventId id = ids_(type);
  if (known.size() < kMostTypesOfField) {
    known.emplace(value, id);
  }
  return id;
}

Encoder::Encoder(const EncodingRules& rules, EventIds ids)
    : rules_(rules),
      ids_(std::move(ids)),
      renames_(std::make_shared<const NameRenames>(rules.renames)),
      include_topics_(std::make_shared<const NamePatterns>(rules.include_topics)),
      exclude_topics_(std::make_shared<const NamePatterns>(rules.exclude_topics)),
      include_sources_(std::make_shared<const NamePatterns>(rules.include_sources)),
      exclude_sources_(std::make_shared<const NamePatterns>(rules.exclude_sources)) {}

std::string Encoder::sourceOf(const std::string& node) const {
  return renames_->apply(stableName(node));
}

std::string Encoder::scopeOf(const std::string& topic) const {
  return renames_->apply(resolvedName(topic));
}

std::optional<core::EventType> Encoder::renamed(const core::EventType& type) const {
  if (!includesTopic(type.scope) || !includesSource(stableName(type.source))) {
    return std::nullopt;
  }
  return core::EventType{tellsSources() ? sourceOf(type.source) : type.source, scopeOf(type.scope),
                         type.type};
}

bool Encoder::includesTopic(const std::string& topic) const {
  const std::string scope = scopeOf(topic);
  return isLegalTopic(topic) && isLegalTopic(scope) &&
         (include_topics_->empty() || include_topics_->match(scope)) &&
         !exclude_topics_->match(scope);
}

bool Encoder::includesSource(const std::string& source) const {
  if (rules_.source == EncodingRules::Source::kNone) {
    return true;
  }
  const std::string name = renames_->apply(source);
  return (include_sources_->empty() || include_sources_->match(name)) &&
         !exclude_sources_->match(name);
}

std::optional<core::EventType> Encoder::played(const Connection& connection) const {
  const std::string source = stableName(connection.callerid);
  if (!tellsSources() || source.substr(source.rfind('/') + 1) != "play" ||
      includesSource(source) || !includesTopic(connection.topic) ||
      Siblings::mayCover(connection.topic)) {
    return std::nullopt;
  }
  return core::EventType{connection.callerid, scopeOf(connection.topic), connection.datatype};
}

bool Encoder::listens(const std::string& source) const {
  const std::string name = renames_->apply(source);
  return !exclude_sources_->match(name) && !isRostopic(name);
}

std::optional<core::EventType> Encoder::typeOf(const Connection& connection) const {
  if (!whyLeftOut(connection).empty() || isOwnType(connection.datatype) ||
      !includesTopic(connection.topic) || !includesSource(stableName(connection.callerid))) {
    return std::nullopt;
  }
  return core::EventType{tellsSources() ? sourceOf(connection.callerid) : "",
                         scopeOf(connection.topic), connection.datatype};
}

std::optional<ConnectionEncoder> Encoder::connect(const Connection& connection) const {
  const std::optional<core::EventType> type = typeOf(connection);
  if (!type) {
    return std::nullopt;
  }
  ConnectionEncoder encoder;
  encoder.ids_ = ids_;
  encoder.type_ = *type;
  encoder.skip_next_ = connection.latching && !isRostopic(stableName(connection.callerid));
  const std::string field = typeFieldOf(rules_, connection);
  if (!field.empty()) {
    const auto classes = rules_.classes.find(connection.datatype);
    const bool numeric = classes != rules_.classes.end();
    encoder.field_ = std::make_shared<const MessageField>(
        connection.definition, connection.datatype, field,
        numeric ? MessageField::Kind::kNumber : MessageField::Kind::kText);
    encoder.field_name_ = field;
    if (numeric && classes->second.bounds.empty()) {
      throw std::invalid_argument("the classes of " + connection.datatype + ": " + field +
                                  " are not learned yet: train learns them from bags");
    }
    if (numeric) {
      encoder.bounds_ = classes->second.bounds;
      encoder.class_names_ = namesOfClasses(encoder.bounds_);
    }
  }
  if (rules_.mode && rules_.mode->topic == encoder.type_.scope) {
    try {
      encoder.mode_field_ = std::make_shared<const MessageField>(
          connection.definition, connection.datatype, rules_.mode->field);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("the mode on " + rules_.mode->topic + ": " + error.what());
    }
  }
  return encoder;
}

}  // namespace self_awareness::ros1
