#include "core/paper/delay_bins.h"

#include <limits>

namespace self_awareness::core::paper {

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
  // Marks wrap around, so the sign of the difference says which one is later.
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
