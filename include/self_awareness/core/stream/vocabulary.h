#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// A model that knows a smaller share of the event types of a stream is hardly that of its robot.
constexpr double kLeastKnown = 0.5;

/// Stands for all modes of the robot (mode.h) that a vocabulary lacks, where events have ids and
/// nobody knows their types: in recordings that limits are found by.
constexpr EventId kOtherMode = std::numeric_limits<EventId>::max();

/// The set U_E of event types, each with a dense id in the order of first appearance
/// (docs/method.md, section 1.1).
class Vocabulary {
 public:
  Vocabulary() = default;
  /// @throw std::invalid_argument if a type occurs twice.
  explicit Vocabulary(const std::vector<EventType>& types);

  /// The same ids, with other names.
  /// @throw std::invalid_argument if two types become one
  Vocabulary renamed(const std::function<EventType(const EventType&)>& name) const;
  /// Id of `type`; a new type is added.
  EventId intern(const EventType& type);
  std::optional<EventId> find(const EventType& type) const;
  /// @throw std::out_of_range if there is no such id
  const EventType& at(EventId id) const { return types_.at(id); }
  /// Whether an id is that of a type that tells the mode of the robot (mode.h), or kOtherMode.
  bool tellsMode(EventId id) const { return is(id, Says::kMode) || id == kOtherMode; }
  /// Whether an id is that of a type that says that a message is held ready.
  bool isLatched(EventId id) const { return is(id, Says::kLatched); }
  /// Whether an id is that of a type that says what messages list (listed.h).
  bool tellsList(EventId id) const { return is(id, Says::kList); }
  /// Whether its events are messages of their own: none of these.
  bool isMessage(EventId id) const {
    return id < says_.size() ? says_[id] == Says::kMessage : id != kOtherMode;
  }
  std::size_t size() const { return types_.size(); }
  const std::vector<EventType>& types() const { return types_; }

 private:
  enum class Says : std::uint8_t { kMessage, kMode, kLatched, kList };

  bool is(EventId id, Says what) const { return id < says_.size() && says_[id] == what; }

  std::vector<EventType> types_;
  std::vector<Says> says_;  // by id: events ask all the time
  std::map<EventType, EventId> ids_;
};

}  // namespace self_awareness::core
