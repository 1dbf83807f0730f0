#pragma once

#include <cstdint>
#include <vector>

namespace self_awareness::core {

/// How delays are put into bins.
struct Binning {
  std::int64_t bin_size = 10000000;  ///< s_b [ns], > 0
  std::int64_t horizon_bins = 0;     ///< delays of this many bins or more share one overflow bin
                                     ///< with this index; 0: unbounded, as in the paper

  /// Bin of a delay [ns] by integer floor division; a negative delay (a late stamp) counts as 0.
  std::int64_t bin(std::int64_t delay) const;
  /// @throw std::invalid_argument if a value is out of range.
  void validate() const;
};

bool operator==(const Binning& a, const Binning& b);

/// Counts of delays per bin: P_ij of the paper before it is normalised. Sparse, sorted by bin.
class Histogram {
 public:
  struct Entry {
    std::int64_t bin = 0;
    std::uint64_t count = 0;
  };

  void add(std::int64_t bin, std::uint64_t count = 1);
  /// Adds the counts of another histogram with the same binning.
  void merge(const Histogram& other);

  std::uint64_t total() const { return total_; }
  std::uint64_t count(std::int64_t bin) const;
  bool empty() const { return entries_.empty(); }
  const std::vector<Entry>& entries() const { return entries_; }

  /// Shannon entropy of the normalised histogram [bit]; 0 if it is empty.
  double entropyBits() const;
  /// Smallest bin below or in which the given fraction (0 to 1) of the counts lies; 0 if empty.
  std::int64_t quantile(double fraction) const;

 private:
  std::vector<Entry> entries_;
  std::uint64_t total_ = 0;
};

bool operator==(const Histogram& a, const Histogram& b);

}  // namespace self_awareness::core
