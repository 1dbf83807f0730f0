#include "self_awareness/core/verdict/suspect.h"

#include <cstdio>
#include <stdexcept>

namespace self_awareness::core {

std::string toString(Kind kind) {
  switch (kind) {
    case Kind::kDied:
      return "died";
    case Kind::kSlow:
      return "slow";
    case Kind::kFast:
      return "fast";
    case Kind::kLate:
      return "late";
    case Kind::kEarly:
      return "early";
    case Kind::kOutOfOrder:
      return "out of order";
    case Kind::kNeverCame:
      return "never came";
    case Kind::kStranger:
      return "stranger";
    case Kind::kUnsubscribed:
      return "not subscribed";
    case Kind::kStale:
      return "stale";
    case Kind::kLossy:
      return "lossy";
    case Kind::kOtherSize:
      return "other size";
    case Kind::kStuck:
      return "stuck";
    case Kind::kBusyMachine:
      return "busy machine";
    case Kind::kAllSilent:
      return "all silent";
    case Kind::kNewMode:
      return "new mode";
  }
  throw std::invalid_argument("a kind without a name");
}

std::optional<Kind> kindOf(const std::string& name) {
  for (int kind = 0; kind <= static_cast<int>(Kind::kNewMode); ++kind) {
    if (toString(static_cast<Kind>(kind)) == name) {
      return static_cast<Kind>(kind);
    }
  }
  return std::nullopt;
}

bool isMissing(Kind kind) {
  return isAbsence(kind) || kind == Kind::kSlow || kind == Kind::kLate;
}

bool isAbsence(Kind kind) {
  return kind == Kind::kDied || kind == Kind::kNeverCame;
}

Reason strangerIn(std::size_t events) {
  Reason reason;
  reason.kind = Kind::kStranger;
  reason.unit = unit::kEvents;
  reason.value = static_cast<double>(events);
  reason.usual = 0;
  reason.words = "never seen in training, " + std::to_string(events) + " in this window";
  return reason;
}

Reason strangerBefore(double age) {
  Reason reason;
  reason.kind = Kind::kStranger;
  reason.unit = unit::kSeconds;
  reason.value = age;
  char text[80];
  std::snprintf(text, sizeof text, "never seen in training, the last one %.1f s ago", age);
  reason.words = text;
  return reason;
}

}  // namespace self_awareness::core
