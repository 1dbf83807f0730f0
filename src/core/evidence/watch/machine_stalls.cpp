#include "self_awareness/core/evidence/watch/machine_stalls.h"

#include <algorithm>
#include <functional>

#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {

MachineStalls::MachineStalls(const Tuning& tuning)
    : least_margin_(tuning.least_margin),
      shortest_(toNanoseconds(tuning.shortest_stall)),
      between_(toNanoseconds(tuning.between_stalls)) {}

void MachineStalls::add(std::int64_t stamp) {
  if (start_ && stamp - newest_ > shortest_) {
    silences_.push_back({events_, stamp, stamp - newest_});
  }
  newest_ = start_ ? std::max(newest_, stamp) : stamp;
  start_ = start_.value_or(stamp);
  ++events_;
}

std::vector<MachineStall> MachineStalls::find() const {
  if (!start_ || between_ <= 0) {
    return {};
  }
  // Longer ones come less often than one is forgiven.
  const auto usual = static_cast<std::size_t>((newest_ - *start_) / between_);
  std::int64_t longer_than = shortest_;
  if (usual < silences_.size()) {
    std::vector<std::int64_t> lengths;
    for (const MachineStall& silence : silences_) {
      lengths.push_back(silence.length);
    }
    const auto place = lengths.begin() + static_cast<std::ptrdiff_t>(usual);
    std::nth_element(lengths.begin(), place, lengths.end(), std::greater<>());
    longer_than = toNanoseconds(least_margin_ * toSeconds(*place));
  }
  std::vector<MachineStall> stalls;
  for (const MachineStall& silence : silences_) {
    const bool alone = stalls.empty() || silence.end - stalls.back().end > between_;
    if (alone && silence.length > longer_than && silence.length <= kRateSpan) {
      stalls.push_back(silence);
    }
  }
  return stalls;
}

}  // namespace self_awareness::core::evidence
