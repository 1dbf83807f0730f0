#pragma once

#include <cstddef>
#include <vector>

namespace self_awareness::core::evidence {

/// Tells that what is heard drifts towards the limits, before it is beyond them, by a test whose
/// false alarms over a lifetime are bounded (docs/learn.md).
///
/// A sample is the largest share of its limit that each component reached in a start of the robot,
/// or in a day of one. As long as nothing changes, no order of the samples is more probable than
/// another one. So the rank of each among those before it is a draw: of `k` samples, it is the
/// largest with a probability of 1 / k, however the shares are distributed. Somebody who bets on
/// high ranks has 1 at the beginning, and on average 1 for ever: that he ever has `x` or more has
/// a probability of 1 / x (Ville). Each component has a better of its own, and is told at the
/// number of components / kFalseAlarms.
class Drift {
 public:
  /// Probability that a robot in which nothing changes is ever told to drift.
  static constexpr double kFalseAlarms = 0.01;

  /// What is known of a component.
  struct Component {
    double evidence = 1;      ///< what the better has: 1 at the beginning
    double usual = 0;         ///< median share of all samples; 0: there are none
    double last = 0;          ///< share of the last one
    std::size_t told_by = 0;  ///< number of the sample, from 1, that told it first; 0: none did
  };

  /// @param components number of them
  explicit Drift(std::size_t components);

  /// Takes in the next sample.
  /// @param shares by component, 0 or more; 1 is the limit
  /// @throw std::invalid_argument if their number is another one, or one is not finite or below 0
  void add(const std::vector<double>& shares);
  /// Looks at a sample, and takes in nothing.
  /// @throw std::invalid_argument as add()
  void check(const std::vector<double>& shares) const;

  /// Number of samples so far.
  std::size_t samples() const { return samples_; }
  /// Evidence from which on a component is told.
  double needed() const { return static_cast<double>(bets_.size()) / kFalseAlarms; }
  Component component(std::size_t number) const;

 private:
  /// On one component. The better divides what he has between strategies, and goes over from one
  /// to another again and again: a drift begins at any time.
  struct Bets {
    std::vector<double> shares;  // of all samples, the smallest first
    double last = 0;
    std::vector<double> stakes;  // by strategy
    std::size_t told_by = 0;
  };

  std::vector<Bets> bets_;
  std::size_t samples_ = 0;
};

}  // namespace self_awareness::core::evidence
