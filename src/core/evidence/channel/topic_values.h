#pragma once

#include <map>
#include <vector>

#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"

namespace self_awareness::core::evidence {

/// Event types that differ by a value alone, by what they are without it. Modes are none.
inline std::map<EventType, std::vector<EventId>> valuesByTopic(const Vocabulary& vocabulary) {
  std::map<EventType, std::vector<EventId>> values;
  for (EventId id = 0; id < vocabulary.size(); ++id) {
    const EventType& type = vocabulary.at(id);
    if (!valueOf(type).empty() && !vocabulary.tellsMode(id)) {
      values[withoutValue(type).value()].push_back(id);
    }
  }
  return values;
}

}  // namespace self_awareness::core::evidence
