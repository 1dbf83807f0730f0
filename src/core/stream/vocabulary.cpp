#include "self_awareness/core/stream/vocabulary.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "self_awareness/core/stream/listed.h"
#include "self_awareness/core/stream/mode.h"

namespace self_awareness::core {

Vocabulary::Vocabulary(const std::vector<EventType>& types) {
  for (const EventType& type : types) {
    if (find(type)) {
      throw std::invalid_argument("event type occurs twice: " + toString(type));
    }
    intern(type);
  }
}

Vocabulary Vocabulary::renamed(const std::function<EventType(const EventType&)>& name) const {
  std::vector<EventType> types;
  std::transform(types_.begin(), types_.end(), std::back_inserter(types), name);
  return Vocabulary(types);
}

EventId Vocabulary::intern(const EventType& type) {
  const auto [entry, is_new] = ids_.try_emplace(type, static_cast<EventId>(types_.size()));
  if (is_new) {
    types_.push_back(type);
    says_.push_back(core::tellsMode(type)   ? Says::kMode
                    : core::isLatched(type) ? Says::kLatched
                    : core::tellsList(type) ? Says::kList
                                            : Says::kMessage);
  }
  return entry->second;
}

std::optional<EventId> Vocabulary::find(const EventType& type) const {
  const auto entry = ids_.find(type);
  return entry == ids_.end() ? std::nullopt : std::optional<EventId>(entry->second);
}

}  // namespace self_awareness::core
