#include <algorithm>
#include <cmath>

#include "../check.h"
#include "model_parts.h"
#include "self_awareness/core/evidence/channel/track.h"
#include "self_awareness/ros/graph.h"

namespace self_awareness::ros1 {
namespace {

namespace evidence = core::evidence;

constexpr std::size_t kMostTracks = 200000;
// Of evidence, in any unit: no method finds others.
constexpr double kLeastLimit = 1e-9;
constexpr double kLargestLimit = 1e12;
// Of one half, in ns 146 years of robots: what both halves say is added up.
constexpr std::int64_t kLargestSum = std::int64_t{1} << 62U;
// Of one class: what all classes of both halves say is added up.
constexpr std::uint64_t kLargestCount = std::uint64_t{1} << 53U;

/// Whether all are times [ns] from `least` up to ten years: the core multiplies them by small
/// numbers.
bool areTimes(const std::vector<std::int64_t>& times, std::int64_t least) {
  constexpr std::int64_t kLongest = std::int64_t{10} * 365 * 86400 * core::kNanosecondsPerSecond;
  return std::all_of(times.begin(), times.end(),
                     [&](std::int64_t time) { return time >= least && time <= kLongest; });
}

bool isRate(double value) {
  return (value >= 0 && std::isfinite(value)) || std::isnan(value);
}

bool isShare(double value) {
  return (value >= 0 && value <= 1) || std::isnan(value);
}

void checkCalibration(const core::paper::Calibration& calibration) {
  check(std::isfinite(calibration.threshold), "its threshold is not a finite number");
  check(isShare(calibration.auc) && isShare(calibration.true_positive_rate) &&
            isShare(calibration.false_positive_rate) && isRate(calibration.false_alarms_per_hour),
        "a rate of its calibration cannot be");
}

void checkCalibration(const core::Calibration& calibration, std::size_t tracks,
                      std::size_t types) {
  const std::vector<double>& limits = calibration.limits.tracks;
  check(limits.size() == tracks, "its limits are not those of its evidence; calibrate it again");
  // NaN: the track is not judged.
  check(std::none_of(limits.begin(), limits.end(),
                     [](double limit) { return limit < kLeastLimit || limit > kLargestLimit; }),
        "a limit of its evidence cannot be");
  check(tracks == 0 ||
            std::any_of(limits.begin(), limits.end(), [](double limit) { return limit > 0; }),
        "its limits judge nothing; calibrate it again");
  check(calibration.relations.empty() || calibration.relations.size() == tracks,
        "its relations are not those of its evidence");
  for (const evidence::Relation& relation : calibration.relations) {
    check(relation.spread >= 0 && relation.spread <= 1, "the spread of a relation cannot be");
  }
  const std::vector<std::int64_t>& firsts = calibration.limits.firsts;
  check((firsts.empty() || firsts.size() == types) && areTimes(firsts, -1),
        "its first events are not those of its event types");
  check(isRate(calibration.budget) && isRate(calibration.false_alarms_per_hour),
        "a rate of its false alarms cannot be");
}

void checkFindings(const evidence::LimitFinder::Recording& recording, std::size_t tracks,
                   std::size_t types) {
  check(recording.said.size() == tracks, "its findings do not fit its tracks");
  check(recording.parts.size() <= evidence::LimitFinder::kMostParts,
        "its findings have too many parts");
  std::uint64_t windows = 0;
  for (const evidence::LimitFinder::Recording::Part& part : recording.parts) {
    check(part.evidence.size() == tracks && part.longest_gaps.size() == types,
          "its findings do not fit its tracks");
    check(areTimes(part.longest_gaps, 0) &&
              std::all_of(part.evidence.begin(), part.evidence.end(),
                          [](float value) { return value >= 0 && std::isfinite(value); }),
          "its findings are no numbers");
    windows += part.windows;
  }
  check(windows == recording.windows, "its findings have other windows than their parts");
  for (const evidence::Said said : recording.said) {
    check(said <= evidence::Said::kMisleading, "its findings say what this version does not know");
  }
}

void checkAttributes(const evidence::AttributeCounts& counts) {
  for (const evidence::ClassCounts* classes : {&counts.ages, &counts.rises, &counts.sizes}) {
    for (const auto& [number, count] : *classes) {
      check(count < kLargestCount, "its attributes have counts that cannot be");
    }
  }
  for (const std::uint64_t step : counts.steps) {
    check(step < kLargestCount, "its attributes have counts that cannot be");
  }
  check(counts.counted() <= counts.known() &&
            std::max({evidence::total(counts.ages), evidence::total(counts.rises),
                      counts.repeats}) <= counts.counted(),
        "its attributes are of more messages than there are");
  check(areTimes({counts.longest_repeat}, 0), "its attributes have a time that cannot be");
}

void checkType(const evidence::Statistics::Type& type) {
  check(std::max({type.events, type.gaps, type.rate_sum, type.rate_squares}) <
            static_cast<std::uint64_t>(kLargestSum),
        "its evidence has counts that cannot be");
  checkAttributes(type.attributes);
  check(type.attributes.known() <= type.events, "its evidence knows more messages than events");
  check(type.gaps <= type.events, "its evidence has more gaps than events");
  check(type.gap_sum >= 0 && type.gap_sum < kLargestSum &&
            (type.gaps > 0) == !type.longest_gaps.empty() &&
            type.longest_gaps.size() <= evidence::Statistics::kLongestGaps &&
            std::is_sorted(type.longest_gaps.rbegin(), type.longest_gaps.rend()) &&
            areTimes(type.longest_gaps, 0),
        "its evidence has impossible gaps");
}

template <typename Value>
void removeColumns(const std::vector<bool>& stays, std::vector<Value>& columns) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (stays[k]) {
      columns[kept++] = columns[k];
    }
  }
  columns.resize(kept);
}

}  // namespace

void checkModel(const TrainedModel& model) {
  const std::size_t tracks = model.watched.tracks.size();
  const std::size_t types = model.vocabulary().size();
  check(model.window >= core::kShortestWindow && model.window <= core::kLongestWindow,
        "the length of its windows cannot be");
  check(model.statistics.events() > 0, "it was trained on no event");
  check(tracks <= kMostTracks, "it watches too much");
  check(model.graph.edges().size() <= kMostEdges, "it has too many edges");
  check(model.graph.unheard().size() <= kMostEdges,
        "it has too many topics that nobody subscribed to");
  check(model.graph.lasting().size() <= kMostEdges, "it has too many subscriptions");
  check(model.graph.hosts().size() <= kMostHosts, "it has too many computers of sources");
  model.encoding.validate();
  for (const evidence::LimitFinder::Recording& recording : model.findings) {
    checkFindings(recording, tracks, types);
  }
  if (model.paper_calibration) {
    checkCalibration(*model.paper_calibration);
  }
  if (model.calibration) {
    checkCalibration(*model.calibration, tracks, types);
  }
}

void checkCounts(const evidence::Statistics& statistics) {
  check(statistics.duration() >= 0, "its evidence has a negative duration");
  check(statistics.duration() < kLargestSum, "its evidence has a duration that cannot be");
  for (const evidence::Statistics::Recording& recording : statistics.recordings()) {
    check(recording.events.size() <= statistics.size(),
          "its recordings do not fit its event types");
    check(areTimes({recording.longest_silence, recording.longest_stall}, 0) &&
              areTimes(recording.longest_gaps, 0) && areTimes(recording.firsts, -1),
          "its recordings have times that cannot be");
  }
  for (core::EventId id = 0; id < statistics.size(); ++id) {
    checkType(statistics.type(id));
  }
}

void removeUnknownTracks(core::Model& model) {
  std::vector<bool> stays;
  for (const evidence::Track& track : model.watched.tracks) {
    stays.push_back(track.channel != nullptr);
  }
  removeColumns(stays, model.watched.tracks);
  for (evidence::LimitFinder::Recording& recording : model.findings) {
    removeColumns(stays, recording.said);
    for (evidence::LimitFinder::Recording::Part& part : recording.parts) {
      removeColumns(stays, part.evidence);
    }
  }
  if (model.calibration) {
    removeColumns(stays, model.calibration->limits.tracks);
    removeColumns(stays, model.calibration->relations);
  }
}

}  // namespace self_awareness::ros1
