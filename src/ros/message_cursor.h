#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "message_definition.h"

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

}  // namespace self_awareness::ros1
