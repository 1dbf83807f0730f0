#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// Event types with fewer gaps than this in training are not judged: too little is known about
/// their usual gaps.
constexpr std::uint64_t kFewestGaps = 30;
/// Lower end of the usual gaps of an event type: this share of its gaps in training is no longer.
constexpr double kUsualFrom = 0.01;
/// Upper end of the usual gaps of an event type: this share of its gaps in training is no longer.
constexpr double kUsualTo = 0.99;
/// Natural logarithm of a probability. Once a window is abnormal, silences that are less probable
/// are named: one gap in a hundred is as long (docs/method.md, sections 2.5 and 6).
inline const double kRareSilence = std::log(0.01);
/// At most so many suspects are named.
constexpr std::size_t kMostSuspects = 5;

/// What is wrong with a component, or with all of them (docs/alarm.md).
enum class Kind {
  kSilent,        ///< has not come, although it should have: nothing of its component is heard
  kTopicSilent,   ///< the same, of one topic: other things of its component are heard
  kUnanswered,    ///< has not come as an answer: other things of its component are heard
  kSlow,          ///< comes less often than it should
  kFast,          ///< comes more often than it should
  kLate,          ///< comes later than it should: after what it answers to, or after its own last
  kEarly,         ///< comes sooner after another event type than it should
  kOutOfOrder,    ///< comes sometimes too early, sometimes too late
  kNeverCame,     ///< has not come since the start, although it always does
  kStranger,      ///< was never seen in training
  kUnsubscribed,  ///< runs, and does not subscribe to what it did in every start of the training
  kStale,         ///< its stamps are older than they should be
  kLossy,         ///< messages of it are missing
  kOtherSize,     ///< its messages are smaller or larger than they should be
  kStuck,         ///< its messages have the same content again and again
  kBusyMachine,   ///< of an alarm: many are late at once, and none of them is to blame
  kAllSilent,     ///< of an alarm: nobody is heard any more
  kNewMode,       ///< of a suspicion: some that do not hear each other stopped, and others go on
  kTwoSenders,    ///< its topics come from two senders of its name
  kSlowerClock,   ///< it keeps another time than the clock of the simulation, as others do
};

/// "silent", "topic silent", "unanswered", "slow", "fast", "late", "early", "out of order", "never
/// came", "stranger", "not subscribed", "stale", "lossy", "other size", "stuck", "busy machine",
/// "all silent", "new mode", "two senders" or "slower clock".
std::string toString(Kind kind);
/// The kind of this name; none: there is no such kind.
std::optional<Kind> kindOf(const std::string& name);
/// Whether it is that something has not come, or comes too late or too seldom.
bool isMissing(Kind kind);
/// Whether it is that something has not come.
bool isAbsence(Kind kind);
/// The same, of something that was heard before.
bool isSilence(Kind kind);

/// Whether it is of what components share: none of them is to blame.
bool isShared(Kind kind);

/// Units of a reason's values; a channel may have others.
namespace unit {
constexpr char kSeconds[] = "s";          ///< of a silence, a delay, an age
constexpr char kHertz[] = "Hz";           ///< of a rate
constexpr char kEvents[] = "events";      ///< in the window
constexpr char kRequests[] = "requests";  ///< without an answer
constexpr char kScore[] = "score";        ///< of the paper's detector
}  // namespace unit

/// Why an event type is a suspect.
struct Reason {
  /// What is not known.
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  Kind kind = Kind::kSilent;  ///< what is wrong
  std::string after;          ///< the event type that it should come after; empty: its own last
  std::string unit;           ///< of the four values below
  double value = kNone;       ///< what was seen: a silence, a median delay, a rate, a number
  double usual = kNone;       ///< what is to be expected of it; NaN: not known
  double usual_shortest = kNone;  ///< the lower end of what is usual; NaN: not known
  double usual_longest = kNone;   ///< its upper end; NaN: not known
  double lasted = kNone;          ///< the value is of the last so many seconds; NaN: of one moment
  std::size_t of = 0;             ///< delays that the value is of; 0: it is not of delays
  std::size_t times = 0;          ///< of them, unusual
  std::string words;              ///< "silent for 2.31 s, usually every 0.083 s, at most 0.104 s"
  /// Of kUnsubscribed, what it does not subscribe to; of kStranger, what it has from others, or
  /// plays on.
  std::vector<std::string> topics;
  /// Of one that died, time without such an event [s], whatever the value is of; NaN: not known.
  double silence = kNone;
};

/// Why a stranger is one that came in the window.
/// @param events of it in the window
Reason strangerIn(std::size_t events);
/// The same of one that came before the window.
/// @param age of its last event [s]
Reason strangerBefore(double age);

/// Why a stranger is one that sends what came from others in training, who were not heard.
/// @param topics on which it does
/// @param known whether it sent other things in training
/// @param before who sent it in training
/// @param age of its last event [s]
Reason movedTo(const std::string& source, bool known, const std::vector<std::string>& topics,
               const std::vector<std::string>& before, double age);
/// Why a stranger is one that plays a recording on topics of the robot.
Reason playsOn(const std::string& player, const std::vector<std::string>& topics);
/// Why a component is a suspect whose topics come from two senders of its name, alone or among
/// others.
/// @param topics by component, all that do
/// @param all whether the components have no others
Reason comesFromTwo(const std::set<std::pair<std::string, std::string>>& topics, bool all);

/// Why components are suspects that send more often by the same factor.
/// @param number of them
Reason sendsFaster(std::size_t number, double factor);

/// Who may have made a window abnormal, and why (docs/method.md, sections 2.5 and 6).
struct Suspect {
  EventId id = 0;         ///< of the event type
  std::string component;  ///< whose event type it is; empty: not known, as of unknown events
  std::string topic;      ///< of the event type, once an alarm names it
  std::string value;      ///< as valueOf() says, likewise
  /// It alone would be abnormal: its evidence is beyond its limit, or it was never seen in
  /// training. With the paper's detector, which knows no limit of a single event type, the latter
  /// only.
  bool abnormal = false;
  /// Since when what is wrong with it has been so, as far as that is known [ns]: of who has not
  /// come, the last time that it did.
  std::int64_t onset = 0;
  /// Of who is silent beyond its limit, when it was nearly so [ns]; else 0.
  std::int64_t missed = 0;
  /// When the alarm or the suspicion that stands first named its component: end of the window
  /// [ns].
  std::int64_t since = 0;
  /// Components that are unusual, too, and upstream of its component, or followed by it.
  std::set<std::string> roots;
  Reason reason;  ///< why it is one
};

}  // namespace self_awareness::core
