#pragma once

#include <cstdint>
#include <vector>

#include "core/paper/delay_bins.h"
#include "self_awareness/core/paper/histogram.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::paper {

/// The histograms of one e_j with all e_i, laid out for the score of an e_j (docs/method.md,
/// section 2.2). The counts of a pair stand in an array over the run of bins that is well filled,
/// and all arrays stand one after the other. A search finds the few counts outside.
class DelayTable {
 public:
  /// Sums over some e_i.
  struct Sums {
    double probabilities = 0;   ///< of P_ij
    double with_entropies = 0;  ///< of h_ij P_ij [bit]
  };

  /// Adds the pair with the next e_i.
  /// @param entries sorted by bin, with counts > 0
  /// @throw std::length_error if the arrays get too long
  void append(const Histogram::Entries& entries);
  /// Gives back the memory that is not needed. Call it after the last pair.
  void finish();

  /// Number of pairs.
  std::size_t size() const { return first_bins_.size(); }
  /// Sums of the probabilities of the delays since the events seen before, as eq. 3 needs them.
  /// @param seen ids less than the number of pairs
  /// @param mark of the present event
  Sums sums(const SeenTypes& seen, std::uint64_t mark, const DelayBins& bins) const;
  /// P_ij of a bin, 0 to 1; 0 for a pair without counts.
  double probability(EventId from, std::int64_t bin) const;
  /// Sum of the squares of P_ij, by e_i: its mean over the delays that it was learned from.
  std::vector<double> meanProbabilities() const;
  /// h_ij of eq. 4 [bit].
  double entropy(EventId from) const { return entropies_[from]; }

 private:
  struct Scattered {
    EventId from;
    Histogram::Entry entry;
  };

  double scatteredCount(EventId from, std::int64_t bin) const;

  void findCells(const SeenTypes& seen, std::uint64_t mark, const DelayBins& bins,
                 std::size_t first, std::size_t end, std::uint32_t* cells) const;

  // By id of e_i.
  std::vector<double> scales_;               // 1 / total of the counts
  std::vector<double> entropies_;            // [bit]
  std::vector<std::uint32_t> first_bins_;    // of the array
  std::vector<std::uint32_t> starts_ = {1};  // of the array in counts_, and one more for the end

  // The arrays, with a cell after each for all bins outside: 0, or kScattered if some of them have
  // counts.
  std::vector<std::int32_t> counts_ = {0};
  std::vector<Scattered> scattered_;  // sorted by e_i and bin
};

}  // namespace self_awareness::core::paper
