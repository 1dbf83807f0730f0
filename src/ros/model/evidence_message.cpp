#include "self_awareness/ros/model/evidence_message.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "attributes_message.h"
#include "check.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

namespace evidence = core::evidence;

bool areOffsets(const std::vector<std::uint64_t>& offsets, std::size_t groups,
                std::size_t entries) {
  return offsets.size() == groups + 1 && offsets.front() == 0 && offsets.back() == entries &&
         std::is_sorted(offsets.begin(), offsets.end());
}

// Of one half, in ns 146 years of robots: what both halves say is added up.
constexpr std::int64_t kLargestSum = std::int64_t{1} << 62U;

void appendType(const evidence::Statistics::Type& type, self_awareness::Evidence& message) {
  message.events.push_back(type.events);
  message.gaps.push_back(type.gaps);
  message.gap_sums.push_back(type.gap_sum);
  message.longest_gaps.insert(message.longest_gaps.end(), type.longest_gaps.begin(),
                              type.longest_gaps.end());
  message.longest_offsets.push_back(message.longest_gaps.size());
  message.rate_sums.push_back(type.rate_sum);
  message.rate_squares.push_back(type.rate_squares);
  message.attributes.push_back(toMessage(type.attributes));
  message.left_out.insert(message.left_out.end(), type.left_out.begin(), type.left_out.end());
}

void checkSizes(const self_awareness::Evidence& message, std::size_t n) {
  for (const std::size_t size :
       {message.events.size(), message.gaps.size(), message.gap_sums.size(),
        message.rate_sums.size(), message.rate_squares.size(), message.pairs.size()}) {
    check(size == n, "its evidence does not fit its event types");
  }
  check(areOffsets(message.longest_offsets, n, message.longest_gaps.size()) &&
            message.left_out.size() == n * evidence::kDelayBins,
        "its evidence does not fit its event types");
  check(message.attributes.empty() || message.attributes.size() == n,
        "its attributes do not fit its event types");
  check(message.duration >= 0, "its evidence has a negative duration");
  check(message.duration < kLargestSum, "its evidence has a duration that cannot be");
}

evidence::Statistics::Type typeOf(const self_awareness::Evidence& message, std::size_t id) {
  evidence::Statistics::Type type;
  type.events = message.events[id];
  type.gaps = message.gaps[id];
  type.gap_sum = message.gap_sums[id];
  type.rate_sum = message.rate_sums[id];
  type.rate_squares = message.rate_squares[id];
  for (std::size_t k = message.longest_offsets[id]; k < message.longest_offsets[id + 1]; ++k) {
    type.addGap(message.longest_gaps[k]);
  }
  std::copy_n(message.left_out.begin() + static_cast<std::ptrdiff_t>(id * evidence::kDelayBins),
              evidence::kDelayBins, type.left_out.begin());
  check(std::max({type.events, type.gaps, type.rate_sum, type.rate_squares}) <
            static_cast<std::uint64_t>(kLargestSum),
        "its evidence has counts that cannot be");
  if (!message.attributes.empty()) {
    type.attributes = fromMessage(message.attributes[id]);
    check(type.attributes.known() <= type.events, "its evidence knows more messages than events");
  }
  check(type.gaps <= type.events, "its evidence has more gaps than events");
  check(type.gap_sum >= 0 && type.gap_sum < kLargestSum &&
            (type.gaps > 0) == !type.longest_gaps.empty() && areTimes(type.longest_gaps, 0),
        "its evidence has impossible gaps");
  return type;
}

}  // namespace

self_awareness::Evidence toMessage(const evidence::Statistics& statistics) {
  self_awareness::Evidence message;
  message.rate_windows = statistics.rateWindows();
  message.duration = statistics.duration();
  for (const evidence::Statistics::Recording& recording : statistics.recordings()) {
    self_awareness::RecordingCounts counts;
    counts.start = toRosTime(recording.start);
    counts.end = toRosTime(std::max(recording.start, recording.end));
    counts.robot_start = toRosTime(recording.robot_start);
    counts.robot = recording.robot;
    counts.longest_silence = recording.longest_silence;
    counts.longest_stall = recording.longest_stall;
    counts.events = recording.events;
    counts.longest_gaps = recording.longest_gaps;
    counts.firsts = recording.firsts;
    message.recordings.push_back(counts);
  }
  message.longest_offsets.push_back(0);
  for (core::EventId id = 0; id < statistics.size(); ++id) {
    appendType(statistics.type(id), message);
    message.pairs.push_back(pairsMessage(statistics, id));
  }
  return message;
}

self_awareness::EvidencePairs pairsMessage(const evidence::Statistics& statistics,
                                           core::EventId id) {
  self_awareness::EvidencePairs message;
  message.id = id;
  message.offsets.push_back(0);
  const evidence::Partners& partners = statistics.partners(id);
  for (std::size_t k = 0; k < partners.size(); ++k) {
    const evidence::Partner partner = partners.at(k);
    for (std::size_t bin = 0; bin < partner.delays.size(); ++bin) {
      if (partner.delays[bin] > 0) {
        message.bins.push_back(static_cast<std::uint8_t>(bin));
        message.counts.push_back(partner.delays[bin]);
      }
    }
    if (partner.answers > 0 || message.offsets.back() < message.bins.size()) {
      message.partners.push_back(partner.id);
      message.answers.push_back(partner.answers);
      message.offsets.push_back(message.bins.size());
    }
  }
  return message;
}

evidence::Statistics fromMessage(const self_awareness::Evidence& message,
                                 const core::Vocabulary& vocabulary) {
  const std::size_t n = vocabulary.size();
  checkSizes(message, n);
  evidence::Statistics statistics;
  for (const core::EventType& type : vocabulary.types()) {
    statistics.intern(type);
  }
  statistics.addRateWindows(message.rate_windows);
  statistics.addDuration(message.duration);
  for (const self_awareness::RecordingCounts& counts : message.recordings) {
    check(counts.events.size() <= n && counts.events.size() == counts.longest_gaps.size() &&
              counts.events.size() == counts.firsts.size(),
          "its recordings do not fit its event types");
    check(counts.start <= counts.end, "a recording of it ends before it starts");
    check(areTimes({counts.longest_silence, counts.longest_stall}, 0) &&
              areTimes(counts.longest_gaps, 0) && areTimes(counts.firsts, -1),
          "its recordings have times that cannot be");
    statistics.addRecording({fromRosTime(counts.start), fromRosTime(counts.end),
                             counts.longest_silence, counts.longest_stall, counts.events,
                             counts.longest_gaps, counts.firsts, fromRosTime(counts.robot_start),
                             counts.robot});
  }
  for (core::EventId id = 0; id < n; ++id) {
    statistics.type(id) = typeOf(message, id);
    check(message.pairs[id].id == id, "its evidence does not fit its event types");
    setPairs(message.pairs[id], statistics);
  }
  return statistics;
}

void setPairs(const self_awareness::EvidencePairs& message, evidence::Statistics& statistics) {
  check(message.id < statistics.size() && message.answers.size() == message.partners.size() &&
            areOffsets(message.offsets, message.partners.size(), message.bins.size()) &&
            message.bins.size() == message.counts.size(),
        "its evidence does not fit its event types");
  evidence::Partners partners;
  for (std::size_t k = 0; k < message.partners.size(); ++k) {
    evidence::Partner partner;
    partner.id = message.partners[k];
    partner.answers = message.answers[k];
    for (std::size_t i = message.offsets[k]; i < message.offsets[k + 1]; ++i) {
      check(message.bins[i] < evidence::kDelayBins, "its evidence has an impossible bin");
      partner.delays[message.bins[i]] += message.counts[i];
    }
    partners.append(partner);
  }
  statistics.setPartners(message.id, std::move(partners));
  check(statistics.total(message.id, message.id) <= statistics.type(message.id).gaps,
        "its evidence has more delays than gaps");
}

self_awareness::Track toMessage(const evidence::Track& track) {
  self_awareness::Track message;
  message.name = channelName(track);
  message.to_id = track.to;
  message.from_id = track.from;
  return message;
}

evidence::Track fromMessage(const self_awareness::Track& message) {
  const evidence::Channel* channel = evidence::channelNamed(message.name);
  check(channel != nullptr, "it watches what this version does not know");
  return {channel, message.to_id, message.from_id};
}

self_awareness::RecordingFindings toMessage(const evidence::LimitFinder::Recording& recording) {
  self_awareness::RecordingFindings message;
  message.start = toRosTime(recording.start);
  message.end = toRosTime(std::max(recording.start, recording.end));
  message.robot_start = toRosTime(recording.robot_start);
  message.robot = recording.robot;
  message.windows = recording.windows;
  for (const evidence::LimitFinder::Recording::Part& part : recording.parts) {
    message.part_windows.push_back(part.windows);
    message.evidence.insert(message.evidence.end(), part.evidence.begin(), part.evidence.end());
    message.longest_gaps.insert(message.longest_gaps.end(), part.longest_gaps.begin(),
                                part.longest_gaps.end());
  }
  for (const evidence::Said said : recording.said) {
    message.said.push_back(static_cast<std::uint8_t>(said));
  }
  return message;
}

evidence::LimitFinder::Recording fromMessage(const self_awareness::RecordingFindings& message,
                                             std::size_t tracks, std::size_t types) {
  using Findings = self_awareness::RecordingFindings;
  using evidence::LimitFinder;
  using evidence::Said;
  static_assert(static_cast<int>(Said::kNothing) == Findings::NOTHING &&
                    static_cast<int>(Said::kAsUsual) == Findings::AS_USUAL &&
                    static_cast<int>(Said::kMisleading) == Findings::MISLEADING,
                "the message says what the core says");
  const std::size_t parts = message.part_windows.size();
  check(message.evidence.size() == parts * tracks &&
            message.longest_gaps.size() == parts * types && message.said.size() == tracks,
        "its findings do not fit its tracks");
  check(parts <= evidence::LimitFinder::kMostParts, "its findings have too many parts");
  check(areTimes(message.longest_gaps, 0) &&
            std::all_of(message.evidence.begin(), message.evidence.end(),
                        [](float evidence) { return evidence >= 0 && std::isfinite(evidence); }),
        "its findings are no numbers");
  check(message.start <= message.end, "a recording of its findings ends before it starts");
  check(std::accumulate(message.part_windows.begin(), message.part_windows.end(),
                        std::uint64_t{0}) == message.windows,
        "its findings have other windows than their parts");
  LimitFinder::Recording recording;
  recording.start = fromRosTime(message.start);
  recording.end = fromRosTime(message.end);
  recording.robot_start = fromRosTime(message.robot_start);
  recording.robot = message.robot;
  recording.trained_on = true;
  recording.windows = message.windows;
  for (std::size_t k = 0; k < parts; ++k) {
    const auto evidence = message.evidence.begin() + static_cast<std::ptrdiff_t>(k * tracks);
    const auto gaps = message.longest_gaps.begin() + static_cast<std::ptrdiff_t>(k * types);
    recording.parts.push_back({message.part_windows[k],
                               {evidence, evidence + static_cast<std::ptrdiff_t>(tracks)},
                               {gaps, gaps + static_cast<std::ptrdiff_t>(types)}});
  }
  for (const std::uint8_t said : message.said) {
    check(said <= Findings::MISLEADING, "its findings say what this version does not know");
    recording.said.push_back(static_cast<Said>(said));
  }
  return recording;
}

self_awareness::Relation toMessage(const evidence::Relation& relation) {
  self_awareness::Relation message;
  message.watched = relation.watched;
  message.reaches = relation.reaches;
  message.irregular = relation.irregular;
  message.spread = relation.spread;
  message.starts = static_cast<std::uint32_t>(relation.starts);
  message.starts_needed = static_cast<std::uint32_t>(relation.starts_needed);
  return message;
}

evidence::Relation fromMessage(const self_awareness::Relation& message) {
  check(message.spread >= 0 && message.spread <= 1, "the spread of a relation cannot be");
  return {message.watched != 0, message.reaches != 0, message.irregular != 0,
          message.spread,       message.starts,       message.starts_needed};
}

}  // namespace self_awareness::ros1
