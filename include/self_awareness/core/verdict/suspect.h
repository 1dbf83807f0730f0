#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

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

/// Who may have made a window abnormal, and why (docs/method.md, sections 2.5 and 6).
struct Suspect {
  enum class Reason {
    kSilent,      ///< has not come, although it should have by now
    kLate,        ///< came after an unusually long silence
    kUnknown,     ///< was never seen in training
    kUnusual,     ///< came at delays after the others that were rare or absent in training
    kRate,        ///< comes more or less often than it should
    kDelay,       ///< comes sooner or later after another event type than it should
    kUnanswered,  ///< has not come since another event type asked for it
    kNeverHeard,  ///< has not come since the start, although it always does
    kOther        ///< as `words` say
  };

  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  EventId id = 0;
  std::string component;  ///< whose event type it is; empty: not known, as of unknown events
  /// It alone would be abnormal: its evidence is beyond its limit, or it was never seen in
  /// training. With the paper's detector, which knows no limit of a single event type, the latter
  /// only.
  bool abnormal = false;
  /// When the alarm or the suspicion that stands first named its component: end of the window
  /// [ns].
  std::int64_t since = 0;
  Reason reason = Reason::kSilent;
  /// The reason in words and numbers, from the channel that found it; empty: describe() knows
  /// them.
  std::string words;
  double silence = kNone;         ///< kSilent, kLate: time without such an event [s]; kUnanswered:
                                  ///< time since it was asked for; kNeverHeard: since the
                                  ///< start; kUnknown: since the last one, if there is none in
                                  ///< the window; else NaN
  double usual_shortest = kNone;  ///< kSilent, kLate: 1 % of the gaps in training are shorter [s];
                                  ///< kDelay: 5 % of the delays; kNeverHeard: shortest time
                                  ///< from the start to the first one; else NaN
  double usual_longest = kNone;   ///< kSilent, kLate: 1 % of the gaps in training are longer [s];
                                  ///< kDelay: 5 % of the delays; kNeverHeard: longest time
                                  ///< from the start to the first one; else NaN
  double usual_gap = kNone;       ///< kSilent: mean gap in training [s]; NaN: not known
  double longest_gap = kNone;     ///< kSilent: longest gap in training [s]; NaN: not known
  std::size_t events = 0;         ///< kUnknown, kUnusual: such events in the window; kRate: in the
                                  ///< last kRateSpan
  double usual_fewest = 0;        ///< kRate: the mean of training minus two spreads
  double usual_most = 0;          ///< kRate: the mean of training plus two spreads
  double score = 0;               ///< kUnusual: their mean score
  double usual_score = 0;         ///< kUnusual: the score to expect by training
  std::string other;              ///< kDelay, kUnanswered: the other event type;
                                  ///< empty: its own
  double lasted = 0;              ///< kDelay: the numbers below are of the last so many s
  std::size_t of = 0;             ///< kDelay: delays;
                                  ///< kUnanswered: those without an answer, if they are counted
  std::size_t times = 0;          ///< kDelay: delays of them that were unusual
  double delay = 0;               ///< kDelay: median of the unusual ones, or of all if none is [s]
  double usual_delay = 0;         ///< kDelay: median before, or in training [s]
  double scatter = kNone;         ///< kDelay: some were earlier than usual, some later, by so much
                                  ///< (median) [s]; NaN: nearly all of them on the same side
};

/// The reason in words and numbers: "silent for 2.31 s, usually every 0.083 s, at most 0.104 s".
std::string describe(const Suspect& suspect);

}  // namespace self_awareness::core
