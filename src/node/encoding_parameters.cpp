#include "encoding_parameters.h"

#include <xmlrpcpp/XmlRpcValue.h>

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "self_awareness/ros/stable_name.h"

namespace self_awareness {
namespace {

using XmlRpc::XmlRpcValue;

constexpr char kNamespace[] = "encoding";

/// @throw std::invalid_argument if a parameter is not what it must be
void require(bool holds, const std::string& name, const std::string& must_be) {
  if (!holds) {
    throw std::invalid_argument(name + " must be " + must_be +
                                "; config/encoding.yaml is an example");
  }
}

std::vector<std::string> textsOf(const std::string& name, XmlRpcValue& value,
                                 const char* must_be = "a list of regular expressions") {
  std::vector<std::string> texts;
  require(value.getType() == XmlRpcValue::TypeArray, name, must_be);
  for (int i = 0; i < value.size(); ++i) {
    require(value[i].getType() == XmlRpcValue::TypeString, name, must_be);
    texts.push_back(static_cast<std::string>(value[i]));
  }
  return texts;
}

std::vector<ros1::Rename> renamesOf(const std::string& name, XmlRpcValue& value) {
  constexpr char kForm[] = "a list of pairs: a regular expression, and the name in its place";
  std::vector<ros1::Rename> renames;
  require(value.getType() == XmlRpcValue::TypeArray, name, kForm);
  for (int i = 0; i < value.size(); ++i) {
    const std::vector<std::string> pair = textsOf(name, value[i], kForm);
    require(pair.size() == 2, name, kForm);
    renames.push_back({pair[0], pair[1]});
  }
  return renames;
}

/// The datatypes have slashes, which part the names of parameters: package and type may have come
/// as two levels.
void addFields(const std::string& name, const std::string& prefix, XmlRpcValue& value,
               std::map<std::string, std::string>& fields) {
  require(value.getType() == XmlRpcValue::TypeStruct, name, "fields by datatype");
  for (auto& [key, field] : value) {
    require(field.getType() != XmlRpcValue::TypeStruct || !field.hasMember("classes"),
            name + "/" + prefix + key,
            "a field alone: its classes are learned from bags, by train; record bags");
    if (field.getType() == XmlRpcValue::TypeString) {
      fields[prefix + key] = static_cast<std::string>(field);
    } else {
      addFields(name, prefix + key + "/", field, fields);
    }
  }
}

std::optional<ros1::ModeField> modeOf(const std::string& name, XmlRpcValue& value) {
  if (value.getType() == XmlRpcValue::TypeStruct && value.size() == 0) {
    return std::nullopt;
  }
  ros1::ModeField mode;
  const std::map<std::string, std::string*> parts{{"topic", &mode.topic}, {"field", &mode.field}};
  const std::string form = "a topic and a field: {topic: /mode, field: data}";
  require(
      value.getType() == XmlRpcValue::TypeStruct && value.size() == static_cast<int>(parts.size()),
      name, form);
  for (auto& [key, part] : value) {
    const auto known = parts.find(key);
    require(known != parts.end() && part.getType() == XmlRpcValue::TypeString, name, form);
    *known->second = static_cast<std::string>(part);
  }
  mode.topic = ros1::resolvedName(mode.topic);
  return mode;
}

ros1::EncodingRules::Source sourceOf(const std::string& name, XmlRpcValue& value) {
  const std::string text =
      value.getType() == XmlRpcValue::TypeString ? static_cast<std::string>(value) : "";
  require(text == "callerid" || text == "none", name, "callerid or none");
  return text == "none" ? ros1::EncodingRules::Source::kNone
                        : ros1::EncodingRules::Source::kCallerId;
}

}  // namespace

ros1::EncodingRules loadEncoding(const ros::NodeHandle& private_node_handle) {
  ros1::EncodingRules rules = ros1::EncodingRules::defaults();
  const std::string space = private_node_handle.resolveName(kNamespace);
  XmlRpcValue values;
  if (!private_node_handle.getParam(kNamespace, values)) {
    return rules;
  }
  require(values.getType() == XmlRpcValue::TypeStruct, space, "the keys of an encoding file");
  const std::map<std::string, std::vector<std::string>*> lists{
      {"include_topics", &rules.include_topics},
      {"exclude_topics", &rules.exclude_topics},
      {"include_sources", &rules.include_sources},
      {"exclude_sources", &rules.exclude_sources}};
  for (auto& [key, value] : values) {
    const std::string name = space + "/" + key;
    const auto list = lists.find(key);
    if (list != lists.end()) {
      *list->second = textsOf(name, value);
    } else if (key == "source") {
      rules.source = sourceOf(name, value);
    } else if (key == "rename") {
      rules.renames = renamesOf(name, value);
    } else if (key == "type_fields") {
      rules.type_fields.clear();
      addFields(name, "", value, rules.type_fields);
    } else if (key == "mode") {
      rules.mode = modeOf(name, value);
    } else {
      require(false, name, "left out: there is no such key in an encoding");
    }
  }
  try {
    rules.validate();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(space + ": " + error.what());
  }
  return rules;
}

}  // namespace self_awareness
