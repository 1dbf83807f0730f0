#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "message_definition.h"
#include "text.h"

namespace self_awareness::ros1 {

/// Walks over a serialized message, and never beyond its end: all functions throw
/// std::out_of_range if it is shorter.
class MessageCursor {
 public:
  MessageCursor(const std::uint8_t* data, std::size_t size)
      : rest_(reinterpret_cast<const char*>(data), size) {}

  bool atEnd() const { return rest_.empty(); }
  /// What has not been crossed yet.
  std::string_view rest() const { return rest_; }

  template <typename Number>
  Number number() {
    Number value;
    std::memcpy(&value, advance(sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view string() { return advance(number<std::uint32_t>()); }
  /// @param visit called with every string
  template <typename Visit>
  void cross(const MessageSteps& steps, Visit visit) {
    for (const MessageStep& step : steps) {
      cross(step, visit);
    }
  }

 private:
  std::string_view advance(std::uint64_t bytes) {
    if (bytes > rest_.size()) {
      throw std::out_of_range("the message is shorter than its definition says");
    }
    const std::string_view passed = rest_.substr(0, bytes);
    rest_.remove_prefix(bytes);
    return passed;
  }

  template <typename Visit>
  void cross(const MessageStep& step, Visit& visit) {
    if (step.kind == MessageStep::Kind::kBytes) {
      advance(step.bytes);
      return;
    }
    if (step.kind == MessageStep::Kind::kString) {
      visit(string());
      return;
    }
    const std::uint64_t length = step.length ? *step.length : number<std::uint32_t>();
    if (step.element.size() == 1 && step.element[0].kind == MessageStep::Kind::kBytes) {
      advance(length * step.element[0].bytes);
      return;
    }
    for (std::uint64_t i = 0; i < length && !step.element.empty(); ++i) {
      for (const MessageStep& inner : step.element) {
        cross(inner, visit);
      }
    }
  }

  std::string_view rest_;
};

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
