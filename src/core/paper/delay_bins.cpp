#include "self_awareness/core/paper/delay_bins.h"

#include <limits>
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

DelayBins::DelayBins(const Binning& binning)
    : bin_size_(binning.bin_size),
      last_bin_(binning.horizon_bins > 0 ? binning.horizon_bins
                                         : std::numeric_limits<std::int64_t>::max()) {
  binning.validate();
  while ((std::uint64_t{1} << remainder_bits_) < static_cast<std::uint64_t>(bin_size_)) {
    ++remainder_bits_;
  }
}

void SeenTypes::resize(std::size_t types) {
  masks_.resize(types, 0);
  marks_.resize(types, 0);
}

void SeenTypes::clear() {
  std::fill(masks_.begin(), masks_.end(), 0);
  any_ = false;
}

void SeenTypes::add(EventId id, std::uint64_t mark) {
  // Marks wrap around: what is older is told by the difference.
  const auto after = [](std::uint64_t a, std::uint64_t b) {
    return static_cast<std::int64_t>(a - b) > 0;
  };
  oldest_ = !any_ || after(oldest_, mark) ? mark : oldest_;
  newest_ = !any_ || after(mark, newest_) ? mark : newest_;
  any_ = true;
  marks_[id] = mark;
  masks_[id] = ~std::uint32_t{0};
}

}  // namespace self_awareness::core::paper
