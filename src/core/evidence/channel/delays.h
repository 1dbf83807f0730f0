#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/evidence/channel/channel.h"
#include "core/evidence/channel/sum.h"
#include "core/evidence/count/log_bins.h"

namespace self_awareness::core::evidence {

/// How surprising the delays of a track are.
class DelaySurprise {
 public:
  /// @param halves of the training that the model is learned from
  DelaySurprise(const Model& model, const Halves& halves, EventId from, EventId to);

  /// Surprise of a delay [ns], in standard deviations from the mean: z of the section. 0 if the
  /// delay differs too little from the usual ones to be a fault.
  double operator()(std::int64_t delay) const {
    const double surprise = by_bin_[log_bins::bin(delay)];
    // Seldom: smaller surprises add to no sum, so that it does not matter whether they are
    // harmless.
    return surprise > kSurprising && isHarmless(static_cast<double>(delay)) ? 0 : surprise;
  }

 private:
  static constexpr double kSurprising = 0.5;

  void learnHarmless(const Model& model, EventId from, EventId to);
  bool isHarmless(double delay) const {
    const auto lies = [&](double shifted) { return shortest_ <= shifted && shifted <= longest_; };
    return lies(delay) || (period_ > 0 && (lies(delay - period_) || lies(delay + period_)));
  }
  /// Whether all delays of a bin are harmless for one reason.
  bool isHarmlessBin(std::size_t bin) const;

  std::array<double, kDelayBins> by_bin_{};
  // Delays that differ too little from the usual ones [ns].
  double shortest_ = 0;
  double longest_ = 0;
  double period_ = 0;  // delays near 0 wrap to it, and the other way round [ns]; 0: they do not
};

/// Numbers of the method, as every delay needs them.
struct DelayNumbers {
  explicit DelayNumbers(const Tuning& tuning)
      : drift(tuning.drift),
        regime(toNanoseconds(tuning.slow_change)),
        most_of_limit(tuning.most_of_limit) {}

  /// Share of the regime that a delay makes which comes so long after the one before [ns].
  double shareOfRegime(std::int64_t elapsed) const {
    return static_cast<double>(std::clamp<std::int64_t>(elapsed, 0, regime)) /
           static_cast<double>(regime);
  }

  double drift;
  std::int64_t regime;  // [ns]
  double most_of_limit;
};

/// Sum of the surprises of a track, as in Page's CUSUM test: what is usual takes from the sum,
/// what is unusual adds to it, and it never falls below 0. A fault that lasts is found soon, one
/// that comes and goes is found later, and chance alone hardly adds up.
struct DelaySum {
  double value = 0;
  double cap = kMostSum;
  double regime = 0;       ///< mean surprise of the last minutes
  std::int64_t since = 0;  ///< stamp of the first delay since it was 0 last [ns]

  /// Takes in a delay.
  /// @param stamp of the event that it ends with [ns]
  /// @param count 1, or 0 if it does not count
  /// @param share_of_regime DelayNumbers::shareOfRegime() of the time since the `to` before
  /// @return what was added
  double add(std::int64_t stamp, double surprise, double count, double share_of_regime,
             const DelayNumbers& numbers) {
    since = value > 0 ? since : stamp;
    const double step = (surprise - std::max(regime, 0.0) - numbers.drift) * count;
    value = std::max(std::min(value + step, cap), 0.0);
    regime += (surprise - regime) * (share_of_regime * count);
    return step;
  }
  void capAt(double limit, const DelayNumbers& numbers) {
    cap = capOfSum(limit, numbers.most_of_limit, cap);
  }
  /// Whether it is beyond its limit, once that is known.
  bool isAbnormal(const DelayNumbers& numbers) const {
    return value * numbers.most_of_limit > cap;
  }
  void clear() {
    value = 0;
    regime = 0;
  }
};

/// What a channel of delays expects of its tracks.
class ExpectedDelays : public Expectation {
 public:
  ExpectedDelays(const Model& model, const Halves& halves, std::vector<std::size_t> tracks);

  double leastLimit(std::size_t track) const override;
  double limit(std::size_t track, double largest, double most) const override;
  const DelaySurprise& surprise(std::size_t number) const { return surprises_[number]; }
  const Model& model() const { return model_; }
  /// The track of a number from 0 on: its event types.
  const Track& track(std::size_t number) const;

 private:
  const Model& model_;
  std::vector<DelaySurprise> surprises_;  // by number
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
                    Reason& reason);

}  // namespace self_awareness::core::evidence
