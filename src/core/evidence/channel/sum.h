#pragma once

#include <limits>

/// Where the sums of channels end: an alarm must not last much longer than its cause.
namespace self_awareness::core::evidence {

constexpr double kMostSum = 200;  ///< while its limit is not known

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

}  // namespace self_awareness::core::evidence
