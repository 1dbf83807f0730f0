#include "self_awareness/ros/encoding.h"

#include <ros/names.h>

#include <stdexcept>
#include <utility>

#include "message_definition.h"
#include "message_field.h"
#include "name_patterns.h"
#include "self_awareness/core/stream/listed.h"
#include "self_awareness/core/stream/mode.h"
#include "self_awareness/ros/own_output.h"
#include "self_awareness/ros/stable_name.h"
#include "text.h"

namespace self_awareness::ros1 {
namespace {

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
        std::string path = line.name + "." + field->second;
        if (!definition.listField(path)) {
          definition.field(path);
        }
        return path;
      }
    }
  } catch (const std::invalid_argument&) {
    // It cannot be read, and nobody asked for it.
  }
  return "";
}

/// The field of the elements of an array that messages of a connection list; none: it lies in
/// none, or the definition is not there at all.
/// @throw std::invalid_argument if there is no such field
std::optional<MessageDefinition::ListField> listFieldOf(const Connection& connection,
                                                        const std::string& path) {
  try {
    const MessageDefinition definition(connection.definition, connection.datatype);
    return definition.linesOf(connection.datatype).empty() ? std::nullopt
                                                           : definition.listField(path);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("type field " + connection.datatype + ": " + path + ": " +
                                error.what());
  }
}

}  // namespace

core::EventId internUpTo(std::size_t most, const core::EventType& type,
                         core::Vocabulary& vocabulary) {
  if (vocabulary.size() >= most && !vocabulary.find(type)) {
    return vocabulary.intern({"", "(further topics)", "(further unknown events)"});
  }
  return vocabulary.intern(type);
}

std::string whyLeftOut(const std::string& topic) {
  return isLegalTopic(topic)
             ? ""
             : "no node can subscribe to the topic " + quote(topic) + ": its name is illegal";
}

std::string whyLeftOut(const Connection& connection) {
  for (const std::string* name : {&connection.callerid, &connection.datatype}) {
    if (name->size() > kLongestName && isLegalTopic(connection.topic)) {
      return "the name '" + printable(*name, kLongestQuote) + "...' on the topic " +
             printable(connection.topic, kLongestQuote) + " is too long";
    }
  }
  const core::EventType made_up{"", "", connection.datatype};
  if (core::tellsMode(made_up) || core::isLatched(made_up) ||
      core::tellsList(made_up)) {  // nobody else makes them up
    return "the name " + quote(connection.datatype) + " on the topic " +
           printable(connection.topic, kLongestQuote) + " is no name of a type";
  }
  return whyLeftOut(connection.topic);
}

Connection connectionFrom(const ros::M_string& header, const std::string& topic) {
  // Who records may have been given a relative name; the publisher says the whole one.
  const std::string said = headerField(header, "topic");
  const bool relative = !topic.empty() && topic[0] != '/' && !said.empty();
  return {resolvedName(printable(headerField(header, "callerid"))),
          resolvedName(printable(relative ? said : topic)),
          printable(headerField(header, "type")),
          headerField(header, "message_definition"),
          headerField(header, "latching") == "1",
          printable(headerField(header, "md5sum"))};
}

bool ConnectionEncoder::accept() {
  return !std::exchange(skip_next_, false);
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

std::optional<core::EventId> ConnectionEncoder::list(const std::uint8_t* data, std::size_t size,
                                                     std::int64_t stamp) {
  std::optional<core::Listed> listed =
      listed_field_ ? listed_field_->next(data, size, stamp) : std::nullopt;
  if (!listed) {
    return std::nullopt;
  }
  std::set<std::string> renamed;  // frames have the namespace of their robot, as topics have
  for (const std::string& value : listed->values) {
    renamed.insert(renames_->apply("/" + value).substr(1));
  }
  listed->values = std::move(renamed);
  return ids_({type_.source, type_.scope, core::typeOfList(type_.type, *listed)});
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
  const auto classes = rules_.classes.find(connection.datatype);
  const bool numeric = classes != rules_.classes.end();
  const auto listed = field.empty() || numeric ? std::nullopt : listFieldOf(connection, field);
  // What is latched was sent before, and one connection may bring what several senders list.
  if (listed && !connection.latching && !type->source.empty()) {
    encoder.listed_field_ = std::make_shared<ListedField>(field, *listed);
    encoder.renames_ = renames_;
  } else if (!field.empty() && !listed) {
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
