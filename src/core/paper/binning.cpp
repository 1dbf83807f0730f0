#include "self_awareness/core/paper/binning.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace self_awareness::core::paper {

std::int64_t Binning::bin(std::int64_t delay) const {
  const std::int64_t index = std::max<std::int64_t>(delay, 0) / bin_size;
  return horizon_bins > 0 ? std::min(index, horizon_bins) : index;
}

void Binning::validate() const {
  if (bin_size <= 0) {
    throw std::invalid_argument("bin size must be more than 0 ns, it is " +
                                std::to_string(bin_size));
  }
  if (horizon_bins < 0) {
    throw std::invalid_argument("horizon must be 0 (unbounded) or a number of bins, it is " +
                                std::to_string(horizon_bins));
  }
}

bool operator==(const Binning& a, const Binning& b) {
  return a.bin_size == b.bin_size && a.horizon_bins == b.horizon_bins;
}

}  // namespace self_awareness::core::paper
