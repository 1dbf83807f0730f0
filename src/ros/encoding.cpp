#include "self_awareness/ros/encoding.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "self_awareness/ros/stable_name.h"

namespace self_awareness::ros1 {
namespace {

std::vector<std::regex> compile(const std::vector<std::string>& patterns) {
  std::vector<std::regex> compiled;
  for (const std::string& pattern : patterns) {
    try {
      compiled.emplace_back(pattern);
    } catch (const std::regex_error& error) {
      throw std::invalid_argument("encoding: '" + pattern +
                                  "' is not a regular expression: " + error.what());
    }
  }
  return compiled;
}

bool anyMatches(const std::vector<std::regex>& patterns, const std::string& name) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::regex& pattern) { return std::regex_match(name, pattern); });
}

/// Whether a node is `rostopic pub`, in any namespace.
bool isRostopic(const std::string& source) {
  return source.substr(source.rfind('/') + 1) == "rostopic";
}

std::string headerField(const ros::M_string& header, const std::string& name) {
  const auto field = header.find(name);
  return field == header.end() ? "" : field->second;
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
  for (const auto* patterns :
       {&include_topics, &exclude_topics, &include_sources, &exclude_sources}) {
    compile(*patterns);
  }
}

bool operator==(const EncodingRules& a, const EncodingRules& b) {
  const auto fields = [](const EncodingRules& rules) {
    return std::tie(rules.source, rules.include_topics, rules.exclude_topics,
                    rules.include_sources, rules.exclude_sources, rules.type_fields);
  };
  return fields(a) == fields(b);
}

void checkTypeFields(const EncodingRules& rules, const core::Vocabulary& vocabulary) {
  std::map<std::string, std::size_t> types;  // by datatype
  for (const core::EventType& type : vocabulary.types()) {
    const std::size_t datatype_end = type.type.find('[');
    if (datatype_end == std::string::npos) {
      continue;
    }
    const std::string datatype = type.type.substr(0, datatype_end);
    if (++types[datatype] > kMostTypesOfField) {
      throw std::invalid_argument("the type field " + datatype + ": " +
                                  rules.type_fields.at(datatype) + " has more than " +
                                  std::to_string(kMostTypesOfField) +
                                  " values; name a field that says what a message does, or none "
                                  "for this datatype");
    }
  }
}

Connection connectionFrom(const ros::M_string& header, const std::string& topic) {
  Connection connection;
  connection.callerid = headerField(header, "callerid");
  connection.topic = topic;
  connection.datatype = headerField(header, "type");
  connection.md5sum = headerField(header, "md5sum");
  connection.definition = headerField(header, "message_definition");
  connection.latching = headerField(header, "latching") == "1";
  return connection;
}

bool ConnectionEncoder::accept() {
  const bool accepted = !skip_next_;
  skip_next_ = false;
  return accepted;
}

core::EventId ConnectionEncoder::id() {
  if (!id_) {
    id_ = ids_(type_);
  }
  return *id_;
}

core::EventId ConnectionEncoder::id(const std::uint8_t* data, std::size_t size) {
  const std::string value = field_->read(data, size);
  const auto known = ids_by_value_.find(value);
  if (known != ids_by_value_.end()) {
    return known->second;
  }
  core::EventType type = type_;
  type.type += "[" + field_name_ + "=" + value + "]";
  const core::EventId id = ids_(type);
  ids_by_value_.emplace(value, id);
  return id;
}

Encoder::Encoder(const EncodingRules& rules, EventIds ids)
    : rules_(rules),
      ids_(std::move(ids)),
      include_topics_(compile(rules.include_topics)),
      exclude_topics_(compile(rules.exclude_topics)),
      include_sources_(compile(rules.include_sources)),
      exclude_sources_(compile(rules.exclude_sources)) {}

bool Encoder::includesTopic(const std::string& topic) const {
  return (include_topics_.empty() || anyMatches(include_topics_, topic)) &&
         !anyMatches(exclude_topics_, topic);
}

bool Encoder::includesSource(const std::string& source) const {
  if (rules_.source == EncodingRules::Source::kNone) {
    return true;
  }
  return (include_sources_.empty() || anyMatches(include_sources_, source)) &&
         !anyMatches(exclude_sources_, source);
}

std::optional<ConnectionEncoder> Encoder::connect(const Connection& connection) const {
  const std::string source = stableName(connection.callerid);
  if (!includesTopic(connection.topic) || !includesSource(source)) {
    return std::nullopt;
  }
  ConnectionEncoder encoder;
  encoder.ids_ = ids_;
  encoder.type_.scope = connection.topic;
  encoder.type_.type = connection.datatype;
  encoder.skip_next_ = connection.latching && !isRostopic(source);
  if (rules_.source == EncodingRules::Source::kCallerId) {
    encoder.type_.source = source;
  }
  const auto field = rules_.type_fields.find(connection.datatype);
  if (field != rules_.type_fields.end()) {
    encoder.field_ = std::make_shared<const MessageField>(connection.definition,
                                                          connection.datatype, field->second);
    encoder.field_name_ = field->second;
  }
  return encoder;
}

}  // namespace self_awareness::ros1
