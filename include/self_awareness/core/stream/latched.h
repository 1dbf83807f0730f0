#pragma once

#include <string>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// The type of an event that says that a publisher holds a message ready: it latches, and sent it
/// before it could be heard, as a map. When it came is when somebody began to listen, so it has no
/// delay to anything: all that it tells is that it is there (docs/method.md, section 3.8). No
/// other event type is called so.
/// @param datatype of the message
std::string typeOfLatched(const std::string& datatype);
/// Whether an event type says that.
bool isLatched(const EventType& type);

}  // namespace self_awareness::core
