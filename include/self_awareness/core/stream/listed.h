#pragma once

#include <optional>
#include <set>
#include <string>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// What messages list, as the transforms on /tf have child frames: the values of a field of all
/// elements of an array.
struct Listed {
  std::string field;             ///< with the name of the array, e.g. transforms.child_frame_id
  std::set<std::string> values;  ///< empty: there are too many lists to tell them apart
};

/// The type of an event that says what the messages of a publisher list. It comes besides them,
/// whenever that changes, and again while it lasts: it has no delay to anything (docs/method.md,
/// section 4.5). No other event type is called so.
/// @param datatype of the messages
std::string typeOfList(const std::string& datatype, const Listed& listed);
/// What an event type says of lists; none: it does not.
std::optional<Listed> listedBy(const EventType& type);
/// Whether it says that.
bool tellsList(const EventType& type);

}  // namespace self_awareness::core
