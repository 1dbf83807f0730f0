#pragma once

#include <cstdint>
#include <vector>

namespace self_awareness::core::evidence {

/// Rounded maxima of the blocks of a quantity that is not negative, and how often each came
/// (docs/method.md, section 5.3). The memory does not grow with time, and parts add up in any
/// order.
///
/// A maximum is rounded to the nearest of 256 values between one power of two and the next: by
/// less than 0.2 %. Below kLeast it counts as 0, above kMost as kMost. So there are at most 7682
/// values, 61 kB; for evidence up to 200 there are 4498, 36 kB. Limits differ from those of the
/// exact maxima by less than 0.5 %, or up to about 2 % where the maxima vary by no more than a
/// step: limits of tracks are at least 1.25 times the largest one.
class BlockMaxima {
 public:
  struct Cell {
    float maximum = 0;        ///< rounded
    std::uint32_t count = 0;  ///< blocks, > 0; 2^32 of 10 s are 1361 years
  };

  /// Smaller maxima count as 0: limits are at least 1, and less than a thousandth of that is
  /// nothing.
  static constexpr double kLeast = 1.0 / 1024;
  /// Larger maxima count as this. Only the rate has no cap; it gets here with 500,000 events in
  /// kRateSpan.
  static constexpr double kMost = 1 << 20;

  /// Adds the maximum of a block, or of `count` blocks that have the same.
  /// @param maximum 0 or more
  void add(double maximum, std::uint32_t count = 1);
  /// Adds those of other blocks.
  void merge(const BlockMaxima& other);

  /// Ordered by maximum, the smallest first, each once.
  const std::vector<Cell>& cells() const { return cells_; }
  /// Number of blocks.
  std::uint64_t number() const;
  /// Largest maximum of all blocks; 0 if there is no block.
  double largest() const { return cells_.empty() ? 0 : cells_.back().maximum; }

 private:
  std::vector<Cell> cells_;
};

}  // namespace self_awareness::core::evidence
