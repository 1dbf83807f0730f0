#include "self_awareness/core/stream/latched.h"

#include <string_view>

namespace self_awareness::core {
namespace {

// No value of a field makes such a type: that begins with the name of the field.
constexpr std::string_view kLatched = "[latched]";

}  // namespace

std::string typeOfLatched(const std::string& datatype) {
  return datatype + std::string(kLatched);
}

bool isLatched(const EventType& type) {
  const std::size_t begin = type.type.find('[');
  return begin != std::string::npos && type.type.compare(begin, std::string::npos, kLatched) == 0;
}

}  // namespace self_awareness::core
