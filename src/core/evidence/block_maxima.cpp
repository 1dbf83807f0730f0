#include "self_awareness/core/evidence/block_maxima.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace self_awareness::core::evidence {
namespace {

constexpr int kFractionBits = 8;

float rounded(double maximum) {
  if (maximum < BlockMaxima::kLeast) {
    return 0;
  }
  int exponent = 0;
  const double fraction = std::frexp(std::min(maximum, BlockMaxima::kMost), &exponent);  // >= 1/2
  const double steps = std::floor(std::ldexp(fraction, kFractionBits + 1) + 0.5);
  return static_cast<float>(std::ldexp(steps, exponent - kFractionBits - 1));
}

}  // namespace

void BlockMaxima::add(double maximum, std::uint32_t count) {
  const float value = rounded(maximum);
  auto place =
      std::lower_bound(cells_.begin(), cells_.end(), value,
                       [](const Cell& cell, float other) { return cell.maximum < other; });
  if (place == cells_.end() || place->maximum > value) {
    place = cells_.insert(place, {value, 0});
  }
  place->count += count;
}

void BlockMaxima::merge(const BlockMaxima& other) {
  for (const Cell& cell : other.cells_) {
    add(cell.maximum, cell.count);
  }
}

std::uint64_t BlockMaxima::number() const {
  return std::accumulate(cells_.begin(), cells_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Cell& cell) { return sum + cell.count; });
}

}  // namespace self_awareness::core::evidence
