#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// The type of an event that tells the mode of the robot (docs/robots.md). It is no message of its
/// own: the mode lasts until another one is told. No other event type is called so.
/// @param datatype of the message that tells it
/// @param mode as text
std::string typeOfMode(const std::string& datatype, const std::string& mode);
/// The mode that an event type tells; empty: it tells none.
std::string modeOf(const EventType& type);
/// Whether it tells one.
bool tellsMode(const EventType& type);

/// The mode that the robot is in.
struct LastingMode {
  EventId id = 0;           ///< of what told it
  std::int64_t lasted = 0;  ///< since it was told, or, if that is later, the recording began [ns]
};

/// How long each mode has lasted in a recording. To whom a mode is as good as somebody who
/// publishes all the time, it ticks.
class ModeTime {
 public:
  /// A mode ticks whenever it has lasted for so long more, from when it begins on [ns].
  static constexpr std::int64_t kTick = kNanosecondsPerSecond;

  /// A mode is told.
  /// @param mode none: one that is not known
  /// @param stamp [ns]
  void enter(std::optional<EventId> mode, std::int64_t stamp);
  /// The first event of the recording came: the mode that was told before lasts from here on.
  /// @param stamp [ns]
  void begin(std::int64_t stamp);
  /// A new recording starts with the next event, or the clock was set. The mode lasts on.
  void restart();

  /// The mode that lasts; none: it is not known.
  const std::optional<EventId>& mode() const { return mode_; }
  /// The same, and for how long without a break up to now [ns].
  std::optional<LastingMode> lasting(std::int64_t now) const;
  /// How long a mode has lasted up to now [ns].
  std::int64_t lasted(EventId mode, std::int64_t now) const;
  /// The next tick of the mode that lasts, as an event; none: it comes later than now [ns].
  std::optional<Event> tickUntil(std::int64_t now);

 private:
  struct Of {
    std::int64_t before = 0;  // that it lasted before the mode that lasts began [ns]
    std::int64_t ticks = 0;
  };

  std::optional<EventId> mode_;
  std::optional<std::int64_t> since_;  // it lasts [ns]; none: no event of the recording has come
  std::map<EventId, Of> of_;
};

}  // namespace self_awareness::core
