#pragma once

#include <cstdint>
#include <vector>

namespace self_awareness::core::evidence {

/// How often an event type stays away for how long: the excess of its
/// longest gaps over the shortest of them is taken for exponential. Few gaps tell its mean badly:
/// so what the next ones are expected to be is a Lomax distribution (docs/method.md, section 5.3).
/// Gaps in which nothing was left out say nothing about that.
class GapTail {
 public:
  /// @param longest_gaps [ns], the longest first
  /// @param hours in which they were the longest, more than 0
  /// @param usual gaps are no longer than this [ns]
  /// @param cut_off what silences beyond usual gaps took that recordings cut off [ns]
  /// @param samples of their mean excess, as which they count: gaps of one start are as one. The
  /// fewer, the longer the next ones may be
  GapTail(const std::vector<std::int64_t>& longest_gaps, double hours, double usual,
          double cut_off, double samples);

  /// Age [ns] that gaps reach at a rate; 0: none is longer than usual.
  /// @param rate of such gaps an hour, more than 0
  double age(double rate) const;

 private:
  double shortest_ = 0;  // of the longest gaps, but more than the usual ones [ns]
  double samples_ = 0;   // that say how much longer gaps get
  double excess_ = 0;    // mean of theirs over it [ns]
  double all_ = 0;       // gaps an hour from there on
};

}  // namespace self_awareness::core::evidence
