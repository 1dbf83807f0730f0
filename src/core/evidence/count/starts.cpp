#include "core/evidence/count/starts.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <utility>

namespace self_awareness::core::evidence {

std::vector<std::size_t> startsOf(const std::vector<Span>& recordings, std::int64_t same_start) {
  std::vector<std::size_t> by_time(recordings.size());
  std::iota(by_time.begin(), by_time.end(), 0);
  std::sort(by_time.begin(), by_time.end(), [&](std::size_t a, std::size_t b) {
    return recordings[a].start < recordings[b].start;
  });
  std::vector<std::size_t> starts(recordings.size());
  std::size_t number = 0;
  struct Unknown {
    std::size_t number = 0;
    std::int64_t end = 0;  // of its recordings [ns]
  };
  // Number of a start by its robot, and its time [ns].
  std::map<std::pair<std::string, std::int64_t>, std::size_t> known;
  // The last start of a robot whose time is not known.
  std::map<std::string, Unknown> unknown;
  for (const std::size_t k : by_time) {
    const Span& recording = recordings[k];
    if (recording.robot_start != 0) {
      const auto [start, is_new] =
          known.try_emplace({recording.robot, recording.robot_start}, number);
      number += is_new ? 1 : 0;
      starts[k] = start->second;
      continue;
    }
    const auto [last, is_first] =
        unknown.try_emplace(recording.robot, Unknown{number, recording.end});
    Unknown& start = last->second;
    if (is_first || recording.start - start.end >= same_start) {
      start = {number++, recording.end};
    }
    start.end = std::max(start.end, recording.end);
    starts[k] = start.number;
  }
  return starts;
}

std::size_t numberOfStarts(const std::vector<Span>& recordings, std::int64_t same_start) {
  const std::vector<std::size_t> starts = startsOf(recordings, same_start);
  return starts.empty() ? 0 : *std::max_element(starts.begin(), starts.end()) + 1;
}

std::vector<std::size_t> samplesOf(const std::vector<Span>& recordings, std::int64_t same_start) {
  std::map<std::string, std::size_t> robots;
  std::vector<std::size_t> samples;
  samples.reserve(recordings.size());
  for (const Span& recording : recordings) {
    samples.push_back(robots.try_emplace(recording.robot, robots.size()).first->second);
  }
  return robots.size() > 1 ? samples : startsOf(recordings, same_start);
}

}  // namespace self_awareness::core::evidence
