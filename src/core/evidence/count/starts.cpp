#include "core/evidence/count/starts.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {

std::vector<std::size_t> startsOf(const std::vector<Span>& recordings, std::int64_t same_start) {
  std::vector<std::size_t> by_time(recordings.size());
  std::iota(by_time.begin(), by_time.end(), 0);
  std::sort(by_time.begin(), by_time.end(), [&](std::size_t a, std::size_t b) {
    return recordings[a].start < recordings[b].start;
  });
  std::vector<std::size_t> starts(recordings.size());
  std::size_t number = 0;
  std::map<std::int64_t, std::size_t> known;  // number of a start by its time [ns]
  std::size_t unknown = 0;                    // number of the last start whose time is not known
  std::optional<std::int64_t> end;            // of the recordings of that one [ns]
  for (const std::size_t k : by_time) {
    const Span& recording = recordings[k];
    if (recording.robot_start != 0) {
      const auto [start, is_new] = known.try_emplace(recording.robot_start, number);
      number += is_new ? 1 : 0;
      starts[k] = start->second;
      continue;
    }
    if (!end || recording.start - *end >= same_start) {
      unknown = number++;
      end = recording.end;
    }
    end = std::max(*end, recording.end);
    starts[k] = unknown;
  }
  return starts;
}

std::size_t numberOfStarts(const std::vector<Span>& recordings, std::int64_t same_start) {
  const std::vector<std::size_t> starts = startsOf(recordings, same_start);
  return starts.empty() ? 0 : *std::max_element(starts.begin(), starts.end()) + 1;
}

}  // namespace self_awareness::core::evidence
