#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace self_awareness::core::evidence {

/// Number of bins in which delays are counted: four an octave from 2.5 ms to 10.24 s, one for all
/// shorter and one for all longer delays (docs/method.md, section 3.1).
constexpr std::size_t kDelayBins = 50;

/// What every bin has before a delay is counted (Krichevsky and Trofimov 1981).
constexpr double kPriorCount = 0.5;

/// A number for each bin.
using ByBin = std::array<double, kDelayBins>;

/// Counts of delays, by bin.
struct DelayHistogram : std::array<std::uint32_t, kDelayBins> {
  /// Two bins, the first one not behind the second.
  struct Bins {
    std::size_t first = 0;
    std::size_t last = 0;
  };

  /// Number of delays.
  std::uint64_t total() const;
  /// The bins between which a share (0 to 1) of the delays lies, as many shorter ones before them
  /// as longer ones behind.
  Bins middle(double share) const;
  /// Delay [ns] that a share (0 to 1) of the delays does not exceed: an estimate within its bin.
  /// @param longest delay of all, as far as it is known [ns]
  double quantile(double share, double longest) const;
  /// Probabilities of delays: the shares of the counts, with kPriorCount more in every bin.
  ByBin probabilities() const;
};

/// Sums of such counts, which may need more bits.
using SumOfDelays = std::array<std::uint64_t, kDelayBins>;
/// Natural logarithms of such probabilities.
ByBin logProbabilities(const DelayHistogram& counts);
ByBin logProbabilities(const SumOfDelays& counts);

}  // namespace self_awareness::core::evidence
