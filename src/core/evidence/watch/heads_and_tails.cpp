#include "core/evidence/watch/heads_and_tails.h"

#include <algorithm>

namespace self_awareness::core::evidence {
namespace {

/// The recordings that hear a type.
struct HeardIn {
  double number = 0;
  double length = 0;  // [ns]
  double heads = 0;   // [ns]

  HeardIn(const Statistics& counts, EventId id) {
    for (const Statistics::Recording& recording : counts.recordings()) {
      if (isHeardIn(recording, id)) {
        number += 1;
        length += static_cast<double>(recording.end - recording.start);
        heads += static_cast<double>(recording.firsts[id]);
      }
    }
  }
};

}  // namespace

bool isOftenSilent(const Statistics& counts, EventId id, const Tuning& tuning) {
  const Statistics::Type& type = counts.type(id);
  auto talks = static_cast<double>(type.gap_sum);
  for (const std::int64_t gap : type.longest_gaps) {
    const auto pause = static_cast<double>(gap);
    talks -= pause > tuning.regular * type.meanGap() ? pause : 0;
  }
  // Who talks for less of the time pauses, even if no recording holds a whole pause.
  return talks < tuning.talking * HeardIn(counts, id).length;
}

HeadsAndTails::HeadsAndTails(const Statistics& counts, EventId id, const Tuning& tuning)
    : id_(id), count_(isOftenSilent(counts, id, tuning)) {
  const HeardIn heard_in(counts, id);
  if (!count_ || heard_in.number == 0) {
    return;
  }
  const Statistics::Type& type = counts.type(id);
  const double usual = 2 * heard_in.number * tuning.regular * type.meanGap();
  all_ = std::max(heard_in.length - static_cast<double>(type.gap_sum) - usual, 0.0);
  tail_ = static_cast<std::int64_t>((all_ - heard_in.heads) / heard_in.number);
  for (const Statistics::Recording& recording : counts.recordings()) {
    longest_ = std::max(longest_, longestIn(recording));
  }
}

std::int64_t HeadsAndTails::longestIn(const Statistics::Recording& recording) const {
  if (!count_) {
    return 0;
  }
  return isHeardIn(recording, id_) ? std::max(recording.firsts[id_], tail_)
                                   : recording.end - recording.start;
}

}  // namespace self_awareness::core::evidence
