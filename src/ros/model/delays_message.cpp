#include "self_awareness/ros/model/delays_message.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace self_awareness::ros1 {

self_awareness::DelayHistograms toMessage(const core::paper::DelayStatistics& statistics,
                                          core::EventId to) {
  self_awareness::DelayHistograms message;
  message.to_id = to;
  message.offsets.push_back(0);
  for (core::EventId from = 0; from < statistics.vocabulary().size(); ++from) {
    for (const core::paper::Histogram::Entry& entry : statistics.pair(from, to).entries()) {
      message.bins.push_back(entry.bin);
      message.counts.push_back(entry.count);
    }
    message.offsets.push_back(message.bins.size());
  }
  return message;
}

void addMessage(const self_awareness::DelayHistograms& message,
                core::paper::DelayStatistics& statistics) {
  const std::size_t n = statistics.vocabulary().size();
  if (message.to_id >= n || message.offsets.size() != n + 1 || message.offsets.front() != 0 ||
      message.offsets.back() != message.bins.size() ||
      message.bins.size() != message.counts.size() ||
      !std::is_sorted(message.offsets.begin(), message.offsets.end())) {
    throw std::invalid_argument("its histograms do not fit its event types");
  }
  core::paper::Histogram::Entries entries;
  for (core::EventId from = 0; from < n; ++from) {
    entries.clear();
    std::int64_t least = 0;
    for (std::size_t i = message.offsets[from]; i < message.offsets[from + 1]; ++i) {
      if (message.counts[i] == 0 || message.bins[i] < least ||
          message.bins[i] == std::numeric_limits<std::int64_t>::max()) {
        throw std::invalid_argument("a histogram has an impossible bin");
      }
      least = message.bins[i] + 1;
      entries.push_back({message.bins[i], message.counts[i]});
    }
    statistics.pair(from, message.to_id).add(entries);
  }
}

}  // namespace self_awareness::ros1
