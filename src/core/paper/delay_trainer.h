#pragma once

#include <cstdint>
#include <optional>

#include "core/paper/delay_bins.h"
#include "self_awareness/core/paper/delay_statistics.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::paper {

/// Counts the delays of one recording after the other into a DelayStatistics, all pairs in one
/// pass: listing 1 of the paper, corrected (docs/method.md, section 2.3). Nothing is counted for
/// (i, j) before e_i was seen in the recording, an event is counted before it is tracked, and no
/// delay crosses from one recording into the next. A step of the clock ends a recording, too
/// (stream/clock.h).
class DelayTrainer {
 public:
  /// @param statistics counted into; must outlive the trainer
  explicit DelayTrainer(DelayStatistics& statistics);

  /// Forgets what was seen: the next event belongs to a new recording.
  void startRecording();
  /// @param event with an id of the statistics' vocabulary; in the order of the recording.
  void add(const Event& event);

 private:
  DelayStatistics& statistics_;
  DelayBins bins_;
  SeenTypes seen_;
  std::optional<std::int64_t> last_stamp_;  // [ns]
};

}  // namespace self_awareness::core::paper
