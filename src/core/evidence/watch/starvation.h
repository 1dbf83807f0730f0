#pragma once

#include <cstdint>
#include <deque>

#include "self_awareness/core/evidence/tuning.h"
#include "self_awareness/core/stream/waiting.h"

namespace self_awareness::core::evidence {

/// Knows when the machine had too little time for its processes: then no component is to blame for
/// being late (docs/method.md, section 3.7). It answers by stamps, so that a recording is judged
/// as it was live, where a stretch of time is measured a moment before or after its events come.
class Starvation {
 public:
  explicit Starvation(const Tuning& tuning);

  /// Takes in the next stretch of time.
  void add(const Waiting& waiting);
  /// Whether an event may have waited for a processor.
  /// @param stamp of the event [ns]
  bool holdsBack(std::int64_t stamp) const;
  /// How long processes waited for too long, of the last kRateSpan before `end` and after `from`
  /// [ns].
  std::int64_t waitedIn(std::int64_t from, std::int64_t end) const;
  void restart();

 private:
  double starved_;     // share of a stretch beyond what is usual
  double usual_time_;  // that what is usual is the mean of [ns]
  // A machine that nothing is known of counts as one that was free for so long [ns]. So a load
  // that begins with it is told, and one that stays is usual before it is an alarm.
  double unknown_time_;
  double usual_ = 0;                // share of the time
  double known_for_ = 0;            // [ns], at most usual_time_
  std::deque<Waiting> starved_in_;  // the last ones, one after the other
};

}  // namespace self_awareness::core::evidence
