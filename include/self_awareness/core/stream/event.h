#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>

#include "self_awareness/core/stream/attributes.h"

namespace self_awareness::core {

/// What happened, without the time: e = (source, scope, type) (paper, section IV-C;
/// docs/method.md, section 1.1).
struct EventType {
  std::string source;  ///< the component that produced it (a node's name); empty: not told apart
  std::string scope;   ///< where others perceive it (a topic)
  std::string type;    ///< what it is (a datatype, with the value of its type field if it has one)
};

inline bool operator==(const EventType& a, const EventType& b) {
  return std::tie(a.source, a.scope, a.type) == std::tie(b.source, b.scope, b.type);
}
inline bool operator<(const EventType& a, const EventType& b) {
  return std::tie(a.source, a.scope, a.type) < std::tie(b.source, b.scope, b.type);
}

/// The value that the type field of its messages has: "status.status=4"; empty: they have none.
std::string valueOf(const EventType& type);

/// An event type without the value of its type field, or what is told besides its messages; none:
/// it says neither.
std::optional<EventType> withoutValue(const EventType& type);

/// The type of an event that says that a publisher holds a message ready: it latches, and sent it
/// before it could be heard, as a map. When it came is when somebody began to listen, so it has no
/// delay to anything: all that it tells is that it is there (docs/method.md, section 3.8). No
/// other event type is called so.
/// @param datatype of the message
std::string typeOfLatched(const std::string& datatype);
/// Whether an event type says that.
bool isLatched(const EventType& type);

/// Name of a component: its source, or its scope where the encoding leaves sources out.
inline const std::string& componentOf(const std::string& source, const std::string& scope) {
  return source.empty() ? scope : source;
}

/// "SOURCE SCOPE TYPE", with "-" for an empty source: how people write and read an event type.
std::string toString(const EventType& type);

/// Dense index of an event type in a Vocabulary, from 0.
using EventId = std::uint32_t;

/// One occurrence of an event type.
struct Event {
  std::int64_t stamp = 0;   ///< [ns]
  EventId id = 0;           ///< of its type
  Attributes attributes{};  ///< of the message; of events of older logs, nothing is known
};

constexpr std::int64_t kNanosecondsPerSecond = 1000000000;
constexpr double kNanosecondsPerHour = 3600e9;

/// Nanoseconds to seconds, for showing and for floating point formulas.
inline double toSeconds(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) * 1e-9;
}
/// A time since 1970 [ns] in UTC, as strftime() writes it.
std::string inUtc(std::int64_t time, const char* format);
/// Nobody waits for longer [ns]: 36 years.
constexpr std::int64_t kLongestAge = std::int64_t{1} << 60;
/// Seconds to whole nanoseconds: of a number of the method, or of a limit of silence.
inline std::int64_t toNanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::llround(seconds * 1e9));
}

}  // namespace self_awareness::core
