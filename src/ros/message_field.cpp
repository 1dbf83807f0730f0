#include "self_awareness/ros/message_field.h"

#include <stdexcept>

#include "message_cursor.h"
#include "message_definition.h"
#include "text.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::size_t kLongestValue = 64;  // [bytes]

/// What use() makes of the number that comes next.
template <typename Use>
auto withNumber(const std::string& type, MessageCursor& cursor, const Use& use) {
  if (type == "int8" || type == "byte") {
    return use(cursor.number<std::int8_t>());
  }
  if (type == "int16") {
    return use(cursor.number<std::int16_t>());
  }
  if (type == "uint16") {
    return use(cursor.number<std::uint16_t>());
  }
  if (type == "int32") {
    return use(cursor.number<std::int32_t>());
  }
  if (type == "uint32") {
    return use(cursor.number<std::uint32_t>());
  }
  if (type == "int64") {
    return use(cursor.number<std::int64_t>());
  }
  if (type == "uint64") {
    return use(cursor.number<std::uint64_t>());
  }
  if (type == "float32") {
    return use(cursor.number<float>());
  }
  if (type == "float64") {
    return use(cursor.number<double>());
  }
  return use(cursor.number<std::uint8_t>());  // uint8, char, bool
}

}  // namespace

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
  return way_->type == "string"
             ? printable(cursor.string(), kLongestValue)
             : withNumber(way_->type, cursor, [](auto number) { return std::to_string(number); });
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
