#include "self_awareness/ros/message_field.h"

#include <stdexcept>

#include "message_cursor.h"
#include "message_definition.h"
#include "text.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::size_t kLongestValue = 64;  // [bytes]

}  // namespace

struct MessageField::Way : MessageDefinition::Field {};

MessageField::MessageField(const std::string& definition, const std::string& datatype,
                           const std::string& path) {
  try {
    way_ = std::make_shared<const Way>(Way{MessageDefinition(definition, datatype).field(path)});
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("type field " + datatype + ": " + path + ": " + error.what());
  }
}

std::string MessageField::read(const std::uint8_t* data, std::size_t size) const {
  MessageCursor cursor(data, size);
  cursor.cross(way_->before, [](std::string_view /*passed*/) {});
  const std::string& type = way_->type;
  if (type == "string") {
    return printable(cursor.string(), kLongestValue);
  }
  if (type == "int8" || type == "byte") {
    return std::to_string(cursor.number<std::int8_t>());
  }
  if (type == "int16") {
    return std::to_string(cursor.number<std::int16_t>());
  }
  if (type == "uint16") {
    return std::to_string(cursor.number<std::uint16_t>());
  }
  if (type == "int32") {
    return std::to_string(cursor.number<std::int32_t>());
  }
  if (type == "uint32") {
    return std::to_string(cursor.number<std::uint32_t>());
  }
  if (type == "int64") {
    return std::to_string(cursor.number<std::int64_t>());
  }
  if (type == "uint64") {
    return std::to_string(cursor.number<std::uint64_t>());
  }
  return std::to_string(cursor.number<std::uint8_t>());  // uint8, char, bool
}

}  // namespace self_awareness::ros1
