#include "check.h"

#include "message_cursor.h"
#include "text.h"

namespace self_awareness::ros1 {

void checkMessage(const MessageSteps& steps, const std::uint8_t* data, std::size_t size) {
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

}  // namespace self_awareness::ros1
