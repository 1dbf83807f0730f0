#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {

/// Event types with fewer gaps than this in training are not judged: they have no usual delay to
/// be measured by.
constexpr std::uint64_t kFewestGaps = 30;
/// The usual delay of an event type reaches from the one that this share of its delays in training
/// does not exceed,
constexpr double kUsualFrom = 0.01;
/// to the one that this share does not exceed.
constexpr double kUsualTo = 0.99;
/// Logarithm of the probability below which a silence is worth naming once a window is abnormal:
/// one gap in a hundred is as long.
inline const double kRareSilence = std::log(0.01);
/// No more suspects than this are named.
constexpr std::size_t kMostSuspects = 5;

/// Who may have made a window abnormal, and why.
struct Suspect {
  enum class Reason {
    kSilent,   ///< did not come although it should have by now
    kLate,     ///< came after an unusually long silence
    kUnknown,  ///< was never seen in training
    kUnusual,  ///< came at delays after the others that were rare or absent in training
    kRate,     ///< comes more or less often than it should
    kDelay,    ///< comes sooner or later after another event type than it should
    kAnswer    ///< is left out after another event type more often than it should
  };

  EventId id = 0;
  Reason reason = Reason::kSilent;
  double silence = 0;         ///< kSilent, kLate: time without such an event [s]
  double usual_shortest = 0;  ///< kSilent, kLate: 1 % of the gaps in training are shorter [s];
                              ///< kDelay: 5 % of the delays
  double usual_longest = 0;   ///< kSilent, kLate: 1 % of the gaps in training are longer [s];
                              ///< kDelay: 5 % of the delays
  std::size_t events = 0;     ///< kUnknown, kUnusual: such events in the window; kRate: in the
                              ///< last kRateSpan
  double usual_fewest = 0;    ///< kRate: the mean of training less two spreads
  double usual_most = 0;      ///< kRate: the mean of training and two spreads
  double score = 0;           ///< kUnusual: their mean score
  double usual_score = 0;     ///< kUnusual: the score to expect by training
  std::string other;          ///< kDelay, kAnswer: the other event type; empty: it follows itself
  double delay = 0;           ///< kDelay: the last one [s]
};

/// The reason in words and numbers: "silent for 2.31 s, usually every 0.070 to 0.090 s".
std::string describe(const Suspect& suspect);

}  // namespace self_awareness::core
