#pragma once

#include <cstdint>
#include <vector>

namespace self_awareness::core::evidence {

/// The maxima of blocks of a quantity that is not negative, rounded, and how often each came: in
/// any order and from any number of parts the same, in memory that does not grow with time.
///
/// Rounded to the nearest of 256 values between one power of two and the next: by less than 0.2 %.
/// Less than kLeast counts as 0, more than kMost as kMost, so that there are at most 7682 values,
/// 61 kB; for evidence up to 200 they are 4498, 36 kB.
/// Limits differ from those of the exact maxima by less than 0.5 %, or up to about 2 % where these
/// vary by no more than a step: limits of tracks are at least 1.25 times the largest one.
class BlockMaxima {
 public:
  struct Cell {
    float maximum = 0;        ///< rounded
    std::uint32_t count = 0;  ///< blocks, > 0; 2^32 of 10 s are 1361 years
  };

  /// Limits are at least 1: less than a thousandth of that is nothing,
  static constexpr double kLeast = 1.0 / 1024;
  /// and the rate, the only one without a cap, has this evidence at 500,000 events in 2 s.
  static constexpr double kMost = 1 << 20;

  /// Adds the maximum of a block, or of several that have the same. @param maximum >= 0
  void add(double maximum, std::uint32_t count = 1);
  /// Adds those of other blocks.
  void merge(const BlockMaxima& other);

  /// By maximum, the smallest first, each there once.
  const std::vector<Cell>& cells() const { return cells_; }
  /// Number of blocks.
  std::uint64_t number() const;
  /// Of all blocks; 0 if there is none.
  double largest() const { return cells_.empty() ? 0 : cells_.back().maximum; }

 private:
  std::vector<Cell> cells_;
};

}  // namespace self_awareness::core::evidence
