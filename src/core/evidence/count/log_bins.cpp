#include "core/evidence/count/log_bins.h"

#include <cmath>

namespace self_awareness::core::evidence::log_bins {

std::int64_t lowerEdge(std::size_t bin) {
  return bin == 0 ? 0 : detail::kEdges.at(bin - 1);
}

double middle(std::size_t bin) {
  if (bin == 0) {
    return static_cast<double>(detail::kFirstEdge) / 2;
  }
  const auto lower = static_cast<double>(lowerEdge(bin));
  return bin + 1 == kBins ? lower : std::sqrt(lower * static_cast<double>(lowerEdge(bin + 1)));
}

}  // namespace self_awareness::core::evidence::log_bins
