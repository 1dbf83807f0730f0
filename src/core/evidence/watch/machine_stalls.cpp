#include "self_awareness/core/evidence/watch/machine_stalls.h"

#include <algorithm>
#include <functional>

#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/stream/clock.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {

MachineStalls::MachineStalls(const Tuning& tuning)
    : margin_(tuning.margin_of_silence),
      shortest_(toNanoseconds(tuning.shortest_stall)),
      between_(toNanoseconds(tuning.between_stalls)) {}

void MachineStalls::add(std::int64_t stamp) {
  if (last_ && isClockStep(*last_, stamp)) {
    restart();
  }
  if (!last_) {
    newest_ = stamp;
  } else if (stamp > newest_) {
    const std::int64_t silence = stamp - newest_;
    if (silence > shortest_) {
      silences_.push_back({{events_, stamp, silence}, runs_});
    }
    ran_ += silence;
    newest_ = stamp;
  }
  last_ = stamp;
  ++events_;
}

void MachineStalls::restart() {
  last_.reset();
  ++runs_;
}

std::vector<MachineStall> MachineStalls::find() const {
  if (between_ <= 0) {
    return {};
  }
  // Longer ones come less often than one is forgiven.
  const auto usual = static_cast<std::size_t>(ran_ / between_);
  std::int64_t longer_than = shortest_;
  if (usual < silences_.size()) {
    std::vector<std::int64_t> lengths;
    for (const Silence& silence : silences_) {
      lengths.push_back(silence.stall.length);
    }
    const auto place = lengths.begin() + static_cast<std::ptrdiff_t>(usual);
    std::nth_element(lengths.begin(), place, lengths.end(), std::greater<>());
    longer_than = toNanoseconds(margin_ * toSeconds(*place));
  }
  std::vector<MachineStall> stalls;
  std::size_t run = 0;  // of the last one
  for (const auto& [stall, its_run] : silences_) {
    const bool alone =
        stalls.empty() || its_run != run || stall.end - stalls.back().end > between_;
    if (alone && stall.length > longer_than && stall.length <= kRateSpan) {
      stalls.push_back(stall);
      run = its_run;
    }
  }
  return stalls;
}

}  // namespace self_awareness::core::evidence
