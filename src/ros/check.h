#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "message_cursor.h"
#include "message_definition.h"
#include "text.h"

namespace self_awareness::ros1 {

/// Checks what a file says.
/// @param otherwise in words, where it does not hold; no string is made where it does: some things
/// are checked for every number of a model
/// @throw std::invalid_argument
inline void check(bool holds, const char* otherwise) {
  if (!holds) {
    throw std::invalid_argument(otherwise);
  }
}

/// Longest text in a file's message [bytes]: the definition of an encoding's pattern, or of a
/// name.
constexpr std::size_t kLongestText = 1 << 16;

/// Checks a serialized message before it is read: each length in it fits into it, and nothing is
/// left over; its texts are printable. roscpp's deserializer would make room for what a length
/// says before it looks at the rest.
/// @throw std::invalid_argument says what is wrong
inline void checkMessage(const MessageSteps& steps, const std::uint8_t* data, std::size_t size) {
  MessageCursor cursor(data, size);
  try {
    cursor.cross(steps, [](std::string_view text) {
      if (text.size() > kLongestText || !isPrintable(text)) {
        throw std::invalid_argument(
            "a text in it is no UTF-8, has control characters, or is too long");
      }
    });
  } catch (const std::out_of_range&) {
    throw std::invalid_argument("a length in it is wrong");
  }
  if (!cursor.atEnd()) {
    throw std::invalid_argument("there is more in it than belongs to it");
  }
}

/// Reads a message of a file.
/// @throw std::invalid_argument if it is damaged
template <typename Message>
Message readMessage(const std::uint8_t* data, std::size_t size) {
  static const MessageSteps kSteps = MessageDefinition(ros::message_traits::definition<Message>(),
                                                       ros::message_traits::datatype<Message>())
                                         .whole();
  checkMessage(kSteps, data, size);
  // The stream wants writable bytes, but writes nothing.
  ros::serialization::IStream stream(const_cast<std::uint8_t*>(data),
                                     static_cast<std::uint32_t>(size));
  Message message;
  ros::serialization::deserialize(stream, message);
  return message;
}

}  // namespace self_awareness::ros1
