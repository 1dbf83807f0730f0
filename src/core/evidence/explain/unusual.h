#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/evidence/channel/scorer.h"
#include "core/evidence/explain/causes.h"
#include "core/evidence/explain/excess.h"
#include "core/evidence/watch/recent_events.h"

namespace self_awareness::core::evidence {

/// A window in which something may be unusual, as excuses and the explanation see it.
struct Unusual {
  /// All of it, whatever excuses it has by then.
  const std::vector<Excess>& excesses;
  const Scorer& scorer;  ///< that has closed the window
  const RecentEvents& events;
  const Causes& causes;
  /// By event type of the model; NaN: its silence is not judged.
  const std::vector<double>& limits_of_silence;
  /// Time since sources sent what the model does not know [ns].
  const std::map<std::string, std::int64_t>& strangers;
  /// Event types of the model whose silence says nothing, by id.
  const std::vector<bool>& may_be_silent;

  const Heard& heard() const { return scorer.heard(); }
  bool isAbnormal() const {
    return std::any_of(excesses.begin(), excesses.end(),
                       [](const Excess& excess) { return excess.share > 1; });
  }
};

}  // namespace self_awareness::core::evidence
