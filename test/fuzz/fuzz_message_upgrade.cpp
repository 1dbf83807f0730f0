// Lays messages out as this version does: the definition and the bytes are a stranger's. The input
// is the definition, a zero byte, and the message.

#include <algorithm>
#include <stdexcept>
#include <string>

#include "ros/check.h"
#include "ros/message_upgrade.h"
#include "self_awareness/EventLogGraph.h"
#include "self_awareness/EventLogStart.h"

using namespace self_awareness;  // NOLINT

namespace {

template <typename Message>
void upgrade(const std::string& definition, const std::uint8_t* data, std::size_t size) {
  const std::string datatype = ros::message_traits::datatype<Message>();
  static const ros1::MessageDefinition kOurs(ros::message_traits::definition<Message>(), datatype);
  try {
    const ros1::MessageUpgrade upgrade(ros1::MessageDefinition(definition, datatype), kOurs);
    const std::vector<std::uint8_t> bytes = upgrade.apply(data, size);
    ros1::readMessage<Message>(bytes.data(), bytes.size());
  } catch (const std::invalid_argument&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::uint8_t* const end = data + size;
  const std::uint8_t* const zero = std::find(data, end, 0);
  const std::uint8_t* const message = zero == end ? end : zero + 1;
  const std::string definition(data, zero);
  upgrade<self_awareness::EventLogStart>(definition, message,
                                         static_cast<std::size_t>(end - message));
  upgrade<self_awareness::EventLogGraph>(definition, message,
                                         static_cast<std::size_t>(end - message));
  return 0;
}
