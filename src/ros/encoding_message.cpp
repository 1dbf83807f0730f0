#include "self_awareness/ros/encoding_message.h"

#include <stdexcept>

namespace self_awareness::ros1 {

self_awareness::Encoding toMessage(const EncodingRules& rules) {
  self_awareness::Encoding message;
  message.source = rules.source == EncodingRules::Source::kNone
                       ? self_awareness::Encoding::SOURCE_NONE
                       : self_awareness::Encoding::SOURCE_CALLERID;
  for (const Rename& rename : rules.renames) {
    self_awareness::Rename& rule = message.renames.emplace_back();
    rule.pattern = rename.pattern;
    rule.name = rename.name;
  }
  message.include_topics = rules.include_topics;
  message.exclude_topics = rules.exclude_topics;
  message.include_sources = rules.include_sources;
  message.exclude_sources = rules.exclude_sources;
  for (const auto& [datatype, field] : rules.type_fields) {
    self_awareness::TypeField type_field;
    type_field.datatype = datatype;
    type_field.field = field;
    if (const auto classes = rules.classes.find(datatype); classes != rules.classes.end()) {
      type_field.classes = static_cast<std::uint8_t>(classes->second.number);
      type_field.bounds = classes->second.bounds;
    }
    message.type_fields.push_back(type_field);
  }
  if (rules.mode) {
    message.mode_topic = rules.mode->topic;
    message.mode_field = rules.mode->field;
  }
  return message;
}

EncodingRules fromMessage(const self_awareness::Encoding& message) {
  EncodingRules rules;
  const bool none = message.source == self_awareness::Encoding::SOURCE_NONE;
  if (!none && message.source != self_awareness::Encoding::SOURCE_CALLERID) {
    throw std::invalid_argument("its encoding has the unknown source '" + message.source + "'");
  }
  rules.source = none ? EncodingRules::Source::kNone : EncodingRules::Source::kCallerId;
  for (const self_awareness::Rename& rule : message.renames) {
    rules.renames.push_back({rule.pattern, rule.name});
  }
  rules.include_topics = message.include_topics;
  rules.exclude_topics = message.exclude_topics;
  rules.include_sources = message.include_sources;
  rules.exclude_sources = message.exclude_sources;
  for (const self_awareness::TypeField& type_field : message.type_fields) {
    if (!rules.type_fields.emplace(type_field.datatype, type_field.field).second) {
      throw std::invalid_argument("its encoding has two type fields of " + type_field.datatype);
    }
    if (type_field.classes > 0) {
      rules.classes[type_field.datatype] = {type_field.classes, type_field.bounds};
    }
  }
  if (!message.mode_topic.empty()) {
    rules.mode = ModeField{message.mode_topic, message.mode_field};
  }
  rules.validate();
  return rules;
}

}  // namespace self_awareness::ros1
