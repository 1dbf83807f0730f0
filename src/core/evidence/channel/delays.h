#pragma once

#include <cstdint>
#include <vector>

#include "core/evidence/channel/channel.h"
#include "core/evidence/count/log_bins.h"

namespace self_awareness::core::evidence {

/// What the delays of a track say against the usual ones (docs/method.md, section 3.5).
class DelaySteps {
 public:
  DelaySteps(const Model& model, EventId from, EventId to);

  /// What a delay [ns] adds to the sum of the track [nat].
  double operator()(std::int64_t delay) const {
    const double step = by_bin_[log_bins::bin(delay)];
    // Seldom: what is unusual.
    return step > usual_ && isHarmless(static_cast<double>(delay)) ? usual_ : step;
  }
  /// What delays add on average [nat], at most, that are as in training.
  double leastUsual() const { return least_usual_; }

 private:
  bool isHarmless(double delay) const {
    const auto lies = [&](double shifted) { return shortest_ <= shifted && shifted <= longest_; };
    return lies(delay) || lies(delay - period_) || lies(delay + period_);
  }

  ByBin by_bin_{};
  double usual_ = 0;  // what a delay of training adds on average [nat]
  double least_usual_ = 0;
  // Delays that differ too little from the usual ones [ns]. A period is a circle: two that come at
  // one moment come in any order.
  double shortest_ = 0;
  double longest_ = 0;
  double period_ = 0;
};

/// A delay that a track has seen.
struct SeenDelay {
  std::int64_t stamp = 0;  // of the later event [ns]
  double delay = 0;        // [ns]
  double step = 0;         // added to the sum
};

/// Says what the delays since the sum was 0 last were (docs/method.md, section 6).
/// @param seen delays of a track, the oldest first
/// @param cap of its sum
/// @param usual delay in training, if too few were seen before [ns]
/// @param now [ns]
/// @param reason what they are after is known, and what is usual of them
void describeDelays(const std::vector<SeenDelay>& seen, double cap, double usual, std::int64_t now,
                    const Tuning& tuning, Reason& reason);

}  // namespace self_awareness::core::evidence
