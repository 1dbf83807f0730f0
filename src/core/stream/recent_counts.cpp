#include "self_awareness/core/stream/recent_counts.h"

#include <algorithm>

namespace self_awareness::core {

RecentCounts::RecentCounts(std::size_t windows) : ring_(windows) {}

void RecentCounts::resize(std::size_t types) {
  if (types == sums_.size()) {
    return;
  }
  open_.resize(types, 0);
  sums_.resize(types, 0);
  for (std::vector<std::uint32_t>& counts : ring_) {
    counts.resize(types, 0);
  }
}

void RecentCounts::close() {
  std::vector<std::uint32_t>& oldest = ring_[closed_ % ring_.size()];
  for (std::size_t id = 0; id < sums_.size(); ++id) {
    sums_[id] += open_[id] - oldest[id];
  }
  oldest.swap(open_);
  std::fill(open_.begin(), open_.end(), 0);
  ++closed_;
}

void RecentCounts::restart() {
  closed_ = 0;
  std::fill(open_.begin(), open_.end(), 0);
  std::fill(sums_.begin(), sums_.end(), 0);
  for (std::vector<std::uint32_t>& counts : ring_) {
    std::fill(counts.begin(), counts.end(), 0);
  }
}

}  // namespace self_awareness::core
