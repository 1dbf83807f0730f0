#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "self_awareness/core/evidence/tuning.h"

namespace self_awareness::core::evidence {

constexpr double kMostSum = 200;  ///< while its limit is not known

/// Where a sum ends: an alarm must not last much longer than its cause.
/// @param limit of the sum; NaN: it has none
/// @param most_of_limit so many times its limit
/// @param cap of now, which stays where there is no limit
inline double capOfSum(double limit, double most_of_limit, double cap) {
  return limit > 0 ? most_of_limit * limit : cap;  // never so where it is NaN
}

/// The limit of a sum, as Expectation::limit(): nobody knows how far one would have grown that
/// ended at its cap.
inline double limitOfSum(double largest, double most) {
  return largest < kMostSum ? most : std::numeric_limits<double>::quiet_NaN();
}

/// What an event adds to a sum that speaks for another hypothesis [nat], by which half of the
/// events are of another kind. Two of them must not be enough.
/// @param ratio of the probability that the other kind has to that of training
/// @param least limit that a sum has
inline double stepOfSum(double ratio, double least) {
  return std::min(std::log((1 + ratio) / 2), least / 2);
}

/// What an event takes from a sum that no event of the other kind is like [nat].
inline const double kStepOfUsual = std::log(2.0);

/// What is beyond chance [nat]: a sum of log(Q/P), which begins with an event, gets there less
/// than once in Tuning::hours_of_chance. From where it begins, it does with a probability of
/// exp(begin - limit) at most (Page 1954), and exp(begin) is Q/P.
/// @param an_hour events that begin it in an hour, if their probability is Q
inline double beyondChance(double an_hour, const Tuning& tuning) {
  return std::max(std::log(an_hour * tuning.hours_of_chance), 0.0);
}

/// Least limit of such a sum [nat].
inline double leastLimitOfSum(double an_hour, const Tuning& tuning) {
  return std::max(tuning.least_sum, beyondChance(an_hour, tuning));
}

/// Sum of what events say, as in Page's CUSUM test: what is usual takes from it, what is unusual
/// adds to it, and it never falls below 0. A fault that lasts is found soon, one that comes and
/// goes is found later, and chance alone hardly adds up.
struct Sum {
  double value = 0;        ///< [nat]
  double cap = kMostSum;   ///< [nat]
  std::int64_t since = 0;  ///< when it was 0 last [ns]

  /// @param from that it grows since if it is 0 now [ns]
  /// @return whether it was 0
  bool add(double step, std::int64_t from) {
    const bool begins = value <= 0;
    since = begins ? from : since;
    value = std::clamp(value + step, 0.0, cap);
    return begins;
  }
  /// Ends it a little above a limit (capOfSum()).
  void capAt(double limit, double most_of_limit) { cap = capOfSum(limit, most_of_limit, cap); }
};

/// A sum of events that are unusual or not, and how many there were since it was 0.
struct CountedSum : Sum {
  std::uint32_t unusual = 0;
  std::uint32_t events = 0;  ///< of either kind

  /// @param more what an unusual one adds [nat]
  /// @param less what a usual one takes [nat]
  void count(bool is_unusual, double more, std::int64_t stamp, double less = kStepOfUsual) {
    if (add(is_unusual ? more : -less, stamp)) {
      unusual = 0;
      events = 0;
    }
    unusual += is_unusual ? 1 : 0;
    ++events;
  }
};

}  // namespace self_awareness::core::evidence
