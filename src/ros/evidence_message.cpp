#include "self_awareness/ros/evidence_message.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace self_awareness::ros1 {
namespace {

void check(bool holds, const std::string& otherwise) {
  if (!holds) {
    throw std::invalid_argument(otherwise);
  }
}

bool areOffsets(const std::vector<std::uint64_t>& offsets, std::size_t groups,
                std::size_t entries) {
  return offsets.size() == groups + 1 && offsets.front() == 0 && offsets.back() == entries &&
         std::is_sorted(offsets.begin(), offsets.end());
}

void appendType(const core::EvidenceStatistics::Type& type, self_awareness::Evidence& message) {
  message.events.push_back(type.events);
  message.gaps.push_back(type.gaps);
  message.gap_sums.push_back(type.gap_sum);
  message.longest_gaps.insert(message.longest_gaps.end(), type.longest_gaps.begin(),
                              type.longest_gaps.end());
  message.longest_offsets.push_back(message.longest_gaps.size());
  message.rate_sums.push_back(type.rate_sum);
  message.rate_squares.push_back(type.rate_squares);
}

void appendPair(const core::EvidenceStatistics::Pair& pair, self_awareness::Evidence& message) {
  for (std::size_t bin = 0; bin < pair.delays.size(); ++bin) {
    if (pair.delays[bin] > 0) {
      message.bins.push_back(static_cast<std::uint8_t>(bin));
      message.counts.push_back(pair.delays[bin]);
    }
  }
  message.offsets.push_back(message.bins.size());
  message.answers.push_back(pair.answers);
}

void checkSizes(const self_awareness::Evidence& message, std::size_t n) {
  for (const std::size_t size :
       {message.events.size(), message.gaps.size(), message.gap_sums.size(),
        message.rate_sums.size(), message.rate_squares.size()}) {
    check(size == n, "its evidence does not fit its event types");
  }
  check(areOffsets(message.longest_offsets, n, message.longest_gaps.size()) &&
            areOffsets(message.offsets, n * n, message.bins.size()) &&
            message.bins.size() == message.counts.size() && message.answers.size() == n * n,
        "its evidence does not fit its event types");
  check(message.duration >= 0, "its evidence has a negative duration");
}

core::EvidenceStatistics::Type typeOf(const self_awareness::Evidence& message, std::size_t id) {
  core::EvidenceStatistics::Type type;
  type.events = message.events[id];
  type.gaps = message.gaps[id];
  type.gap_sum = message.gap_sums[id];
  type.rate_sum = message.rate_sums[id];
  type.rate_squares = message.rate_squares[id];
  for (std::size_t k = message.longest_offsets[id]; k < message.longest_offsets[id + 1]; ++k) {
    type.addGap(message.longest_gaps[k]);
  }
  check(type.gap_sum >= 0 && (type.gaps > 0) == !type.longest_gaps.empty(),
        "its evidence has impossible gaps");
  return type;
}

core::EvidenceStatistics::Pair pairOf(const self_awareness::Evidence& message,
                                      std::size_t number) {
  core::EvidenceStatistics::Pair pair;
  pair.answers = message.answers[number];
  for (std::size_t k = message.offsets[number]; k < message.offsets[number + 1]; ++k) {
    check(message.bins[k] < core::log_bins::kBins, "its evidence has an impossible bin");
    pair.delays.resize(core::log_bins::kBins, 0);
    pair.delays[message.bins[k]] += message.counts[k];
  }
  return pair;
}

}  // namespace

self_awareness::Evidence toMessage(const core::EvidenceStatistics& statistics,
                                   const core::Vocabulary& vocabulary) {
  core::EvidenceStatistics ordered;
  for (const core::EventType& type : vocabulary.types()) {
    ordered.intern(type);
  }
  ordered.merge(statistics);
  self_awareness::Evidence message;
  message.rate_windows = ordered.rateWindows();
  message.duration = ordered.duration();
  message.longest_offsets.push_back(0);
  message.offsets.push_back(0);
  for (core::EventId to = 0; to < ordered.size(); ++to) {
    appendType(ordered.type(to), message);
    for (core::EventId from = 0; from < ordered.size(); ++from) {
      appendPair(ordered.pair(from, to), message);
    }
  }
  return message;
}

core::EvidenceStatistics fromMessage(const self_awareness::Evidence& message,
                                     const core::Vocabulary& vocabulary) {
  const std::size_t n = vocabulary.size();
  checkSizes(message, n);
  core::EvidenceStatistics statistics;
  for (const core::EventType& type : vocabulary.types()) {
    statistics.intern(type);
  }
  statistics.addRateWindows(message.rate_windows);
  statistics.addDuration(message.duration);
  for (core::EventId to = 0; to < n; ++to) {
    statistics.type(to) = typeOf(message, to);
    for (core::EventId from = 0; from < n; ++from) {
      statistics.pair(from, to) = pairOf(message, to * n + from);
    }
  }
  return statistics;
}

core::EvidenceLimits limitsOf(const self_awareness::EvidenceCalibration& message) {
  return {message.limits, message.linker_limit};
}

}  // namespace self_awareness::ros1
