#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// A model that knows a smaller share of the event types of a stream is hardly that of its robot.
constexpr double kLeastKnown = 0.5;

/// The set U_E of event types, each with a dense id in the order of first appearance
/// (docs/method.md, section 1.1).
class Vocabulary {
 public:
  Vocabulary() = default;
  /// @throw std::invalid_argument if a type occurs twice.
  explicit Vocabulary(const std::vector<EventType>& types);

  /// Id of `type`; a new type is added.
  EventId intern(const EventType& type);
  std::optional<EventId> find(const EventType& type) const;
  /// @throw std::out_of_range if there is no such id
  const EventType& at(EventId id) const { return types_.at(id); }
  std::size_t size() const { return types_.size(); }
  const std::vector<EventType>& types() const { return types_; }

 private:
  std::vector<EventType> types_;
  std::map<EventType, EventId> ids_;
};

}  // namespace self_awareness::core
