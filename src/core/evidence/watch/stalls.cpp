#include "core/evidence/watch/stalls.h"

#include <algorithm>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {

Stalls::Stalls(std::int64_t longest_silence, std::int64_t longest_stall, const Tuning& tuning)
    : usual_(std::max(toNanoseconds(tuning.margin_of_silence * toSeconds(longest_silence)),
                      toNanoseconds(tuning.shortest_stall))),
      longest_(
          std::max(toNanoseconds(tuning.longest_stall),
                   std::min(toNanoseconds(tuning.margin_of_silence * toSeconds(longest_stall)),
                            kRateSpan))),
      between_(toNanoseconds(tuning.between_stalls)) {}

void Stalls::restart() {
  last_stamp_ = now_ = at_ = until_ = 0;
}

void Stalls::closeWindow(std::int64_t end, bool heard) {
  // While all are silent, none is more so than the others.
  const std::int64_t silence = heard ? end - last_stamp_ : 0;
  now_ = silence > usual_ && silence <= longest_ ? silence : 0;
}

}  // namespace self_awareness::core::evidence
