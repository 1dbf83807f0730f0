#pragma once

#include <cstdint>

#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/evidence/tuning.h"

namespace self_awareness::core::evidence {

/// What recordings cut off: the time until the first event of a type, and since its last. Nobody
/// knows how long such a silence would have been. It says nothing of who hardly ever pauses: he
/// started later, or was switched off before the recorder was. Who is often silent was silent
/// then, too: it is a pause, of at least this length (docs/method.md, section 5.2).

/// Whether a recording heard an event type.
inline bool isHeardIn(const Statistics::Recording& recording, EventId id) {
  return id < recording.events.size() && recording.events[id] > 0;
}

/// Whether a type is silent for more than a quarter of the time of the recordings that hear it.
bool isOftenSilent(const Statistics& counts, EventId id, const Tuning& tuning);

/// What the recordings of the training cut off of an event type.
class HeadsAndTails {
 public:
  HeadsAndTails(const Statistics& counts, EventId id, const Tuning& tuning);

  /// Whether they count: the type is often silent.
  bool count() const { return count_; }
  /// Length of all of them in recordings that hear the type [ns]; 0 where they do not count.
  double all() const { return all_; }
  /// The longest one [ns], as longestIn().
  std::int64_t longest() const { return longest_; }
  /// The longest of a recording [ns]: the time until the first event of the type, or, as only
  /// their sum is known, the mean of those since the last one; all of it where the type did not
  /// come. 0 where they do not count.
  std::int64_t longestIn(const Statistics::Recording& recording) const;

 private:
  EventId id_;
  bool count_;
  double all_ = 0;         // [ns]
  std::int64_t tail_ = 0;  // mean [ns]
  std::int64_t longest_ = 0;
};

}  // namespace self_awareness::core::evidence
