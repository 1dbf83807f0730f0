// Reads a field of a message by a definition: both are a stranger's. The input is the definition,
// a zero byte, and the message.

#include <algorithm>
#include <stdexcept>
#include <string>

#include "ros/message_field.h"

using namespace self_awareness;  // NOLINT

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::uint8_t* const end = data + size;
  const std::uint8_t* const zero = std::find(data, end, 0);
  const std::uint8_t* const message = zero == end ? end : zero + 1;
  const std::string definition(data, zero);
  for (const char* path : {"action", "header.frame_id", "data"}) {
    try {
      const ros1::MessageField field(definition, "visualization_msgs/Marker", path);
      field.read(message, static_cast<std::size_t>(end - message));
    } catch (const std::invalid_argument&) {
    } catch (const std::out_of_range&) {
    }
  }
  return 0;
}
