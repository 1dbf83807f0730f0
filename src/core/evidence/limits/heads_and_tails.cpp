#include "core/evidence/limits/heads_and_tails.h"

#include <algorithm>

namespace self_awareness::core::evidence {
namespace {

// Who talks for less of the time pauses, even if no recording holds a whole pause.
constexpr double kTalks = 0.75;

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
  return talks < kTalks * HeardIn(counts, id).length;
}

double headsAndTails(const Statistics& counts, EventId id, const Tuning& tuning) {
  if (!isOftenSilent(counts, id, tuning)) {
    return 0;
  }
  const HeardIn heard_in(counts, id);
  const Statistics::Type& type = counts.type(id);
  const double usual = 2 * heard_in.number * tuning.regular * type.meanGap();
  return std::max(heard_in.length - static_cast<double>(type.gap_sum) - usual, 0.0);
}

std::int64_t headOrTail(const Statistics& counts, const Statistics::Recording& recording,
                        EventId id, const Tuning& tuning) {
  if (!isOftenSilent(counts, id, tuning)) {
    return 0;
  }
  if (!isHeardIn(recording, id)) {
    return recording.end - recording.start;
  }
  const HeardIn heard_in(counts, id);
  const double tails = headsAndTails(counts, id, tuning) - heard_in.heads;
  return std::max(recording.firsts[id], static_cast<std::int64_t>(tails / heard_in.number));
}

}  // namespace self_awareness::core::evidence
