#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "message_cursor.h"
#include "text.h"

namespace self_awareness::ros1 {

/// Strings are cut after so many bytes.
constexpr std::size_t kLongestValue = 64;

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

/// The integer, bool or string that comes next, as text in UTF-8.
inline std::string textOf(const std::string& type, MessageCursor& cursor) {
  return type == "string"
             ? printable(cursor.string(), kLongestValue)
             : withNumber(type, cursor, [](auto number) { return std::to_string(number); });
}

}  // namespace self_awareness::ros1
