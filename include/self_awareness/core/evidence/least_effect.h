#pragma once

namespace self_awareness::core::evidence {

/// A rate that changes by this share is no fault: clocks and loads differ from day to day
/// (docs/method.md, section 3.3).
constexpr double kLeastRateEffect = 0.04;

/// What a delay must differ by from the usual ones to be a fault: the larger of a time and a share
/// of the period (docs/method.md, section 3.4). The defaults are measured (section 7.4 there).
struct LeastEffect {
  double time = 5e6;        ///< [ns], finite, 0 or more
  double of_period = 0.02;  ///< 0 to below 1

  /// @throw std::invalid_argument names the number that is out of its range
  void validate() const;

  /// Least effect on the delay from one event type to another [ns].
  /// @param period mean gap of the one that the delay counts from [ns]
  double onDelay(double period) const;
  /// Least effect on the gaps of one event type [ns].
  /// @param period mean gap of the event type [ns]
  double onGap(double period) const;
};

}  // namespace self_awareness::core::evidence
