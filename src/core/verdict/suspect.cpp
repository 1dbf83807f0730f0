#include "self_awareness/core/verdict/suspect.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/verdict/name_list.h"

namespace self_awareness::core {
namespace {

constexpr std::size_t kMostOfReason = 3;
constexpr double kPause = 2;  // of who sends on [s]

// In the order of Kind.
constexpr std::array kNames{"silent",     "topic silent", "unanswered",     "slow",
                            "fast",       "late",         "early",          "out of order",
                            "never came", "stranger",     "not subscribed", "stale",
                            "lossy",      "other size",   "stuck",          "busy machine",
                            "all silent", "new mode",     "two senders",    "slower clock"};
static_assert(kNames.size() == static_cast<std::size_t>(Kind::kSlowerClock) + 1);

std::string number(std::size_t count, const std::string& of) {
  return std::to_string(count) + " " + of + (count == 1 ? "" : "s");
}

}  // namespace

std::string toString(Kind kind) {
  return kNames.at(static_cast<std::size_t>(kind));
}

std::optional<Kind> kindOf(const std::string& name) {
  if (name == "died") {  // as files of before have it
    return Kind::kSilent;
  }
  const auto* const found = std::find(kNames.begin(), kNames.end(), name);
  return found == kNames.end() ? std::nullopt
                               : std::optional(static_cast<Kind>(found - kNames.begin()));
}

bool isMissing(Kind kind) {
  return isAbsence(kind) || kind == Kind::kSlow || kind == Kind::kLate;
}

bool isAbsence(Kind kind) {
  return isSilence(kind) || kind == Kind::kNeverCame;
}

bool isSilence(Kind kind) {
  return kind == Kind::kSilent || kind == Kind::kTopicSilent || kind == Kind::kUnanswered;
}

bool isShared(Kind kind) {
  return kind == Kind::kBusyMachine || kind == Kind::kAllSilent || kind == Kind::kNewMode ||
         kind == Kind::kTwoSenders || kind == Kind::kSlowerClock;
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

Reason movedTo(const std::string& source, bool known, const std::vector<std::string>& topics,
               const std::vector<std::string>& before, double age) {
  Reason reason;
  reason.kind = Kind::kStranger;
  reason.unit = unit::kSeconds;
  reason.value = age;
  reason.topics = topics;
  reason.words = listed(topics, kMostOfReason) + (topics.size() == 1 ? " comes" : " come") +
                 " from " + source + " now, in training from " + listed(before, kMostOfReason);
  if (age > kPause) {
    char text[60];
    std::snprintf(text, sizeof text, ", the last one %.1f s ago", age);
    reason.words += text;
  }
  // Another name renames all that a source sends.
  const std::string rename =
      known || before.size() > 1 ? "" : " with --rename " + source + " " + before.front();
  reason.words += "; not watched until you train again" + rename +
                  "; to accept it: ~accept \"{component: " + source + ", kind: stranger}\"";
  return reason;
}

Reason playsOn(const std::string& player, const std::vector<std::string>& topics) {
  Reason reason;
  reason.kind = Kind::kStranger;
  reason.topics = topics;
  reason.words = player + " plays on " + number(topics.size(), "topic") +
                 " of this robot: " + listed(topics, kMostOfReason);
  return reason;
}

Reason comesFromTwo(const std::set<std::pair<std::string, std::string>>& topics, bool all) {
  std::set<std::string> components;
  for (const auto& [component, topic] : topics) {
    components.insert(component);
  }
  const std::string of =
      components.size() == 1 ? *components.begin() : number(components.size(), "node");
  Reason reason;
  reason.kind = Kind::kTwoSenders;
  reason.words = (topics.size() == 1 ? topics.begin()->second
                  : all              ? "every topic"
                                     : number(topics.size(), "topic")) +
                 " of " + of + (topics.size() == 1 || all ? " comes" : " come") +
                 " from two senders of one name";
  return reason;
}

Reason sendsFaster(std::size_t number, double factor) {
  Reason reason;
  reason.kind = Kind::kSlowerClock;
  char text[120];
  std::snprintf(text, sizeof text,
                "the simulation may run slower: %zu nodes send %.1f times as often by its clock",
                number, factor);
  reason.words = text;
  return reason;
}

}  // namespace self_awareness::core
