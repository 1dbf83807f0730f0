#include "self_awareness/ros/message_field.h"

#include <stdexcept>

#include "message_cursor.h"
#include "message_definition.h"
#include "message_value.h"

namespace self_awareness::ros1 {
struct MessageField::Way : MessageDefinition::Field {};

MessageField::MessageField(const std::string& definition, const std::string& datatype,
                           const std::string& path, Kind kind) {
  try {
    way_ = std::make_shared<const Way>(
        Way{MessageDefinition(definition, datatype).field(path, kind == Kind::kNumber)});
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("type field " + datatype + ": " + path + ": " + error.what());
  }
}

std::string MessageField::read(const std::uint8_t* data, std::size_t size) const {
  MessageCursor cursor = at(data, size);
  return textOf(way_->type, cursor);
}

double MessageField::number(const std::uint8_t* data, std::size_t size) const {
  MessageCursor cursor = at(data, size);
  return withNumber(way_->type, cursor, [](auto number) { return static_cast<double>(number); });
}

MessageCursor MessageField::at(const std::uint8_t* data, std::size_t size) const {
  MessageCursor cursor(data, size);
  cursor.cross(way_->before, [](std::string_view /*passed*/) {});
  return cursor;
}

}  // namespace self_awareness::ros1
