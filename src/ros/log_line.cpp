#include "log_line.h"

#include <algorithm>
#include <stdexcept>

#include "message_cursor.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/stable_name.h"
#include "text.h"

namespace self_awareness::ros1 {

std::optional<SaidLine> readLogLine(const std::uint8_t* data, std::size_t size) {
  try {
    MessageCursor cursor(data, size);
    for (int i = 0; i < 3; ++i) {
      cursor.number<std::uint32_t>();  // sequence number and stamp of the header
    }
    cursor.string();  // frame
    SaidLine line;
    line.level = cursor.number<std::uint8_t>();
    line.node = stableName(std::string(cursor.string().substr(0, kLongestName)));
    std::string text(cursor.string().substr(0, kLongestLine));
    std::replace(text.begin(), text.end(), '\n', ' ');
    line.text = printable(text);
    return line;
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

}  // namespace self_awareness::ros1
