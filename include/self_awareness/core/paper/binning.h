#pragma once

#include <cstdint>

namespace self_awareness::core::paper {

/// How delays fall into bins (docs/method.md, section 2.1).
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

}  // namespace self_awareness::core::paper
