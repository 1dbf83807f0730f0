#include "self_awareness/core/model.h"

#include <stdexcept>
#include <utility>

#include "core/evidence/count/starts.h"
#include "core/evidence/watch/silent_pairs.h"
#include "self_awareness/core/evidence/judge.h"

namespace self_awareness::core {
namespace {

// What all recordings of one start have, somebody may have started by hand.
constexpr std::size_t kFewestStarts = 2;

}  // namespace

void Model::requireDelays() const {
  if (!hasDelays()) {
    throw std::invalid_argument(
        "it holds no counts for the paper's detector; train it again with --detector paper or "
        "both");
  }
}

void Model::requireWatched() const {
  if (!isWatched()) {
    throw std::invalid_argument(
        "it holds no counts for the evidence detector; train it again with --detector evidence "
        "or both");
  }
}

std::optional<std::size_t> Model::onlyHalf() const {
  std::optional<std::size_t> only;
  for (const RecordingInfo& recording : recordings) {
    const std::size_t half = evidence::halfOf(recording.fingerprint);
    if (only.value_or(half) != half) {
      return std::nullopt;
    }
    only = half;
  }
  return only;
}

std::string Model::detectors() const {
  const bool for_evidence = hasEvidence() || isWatched();
  return for_evidence ? (hasDelays() ? "both" : "evidence") : "paper";
}

std::uint64_t Model::gaps(EventId id) const {
  if (hasDelays()) {
    return statistics.pair(id, id).total();
  }
  std::uint64_t gaps = 0;
  for (const evidence::Statistics& half : watched.halves) {
    gaps += half.type(id).gaps;
  }
  return gaps;
}

std::size_t Model::pairs() const {
  if (hasDelays()) {
    return statistics.pairs();
  }
  std::size_t filled = 0;
  for (EventId to = 0; to < evidence[0].size(); ++to) {
    for (EventId from = 0; from < evidence[0].size(); ++from) {
      filled += evidence[0].total(from, to) + evidence[1].total(from, to) > 0 ? 1 : 0;
    }
  }
  return filled;
}

std::set<SourceGraph::Publication> Model::unheard() const {
  std::set<SourceGraph::Publication> unheard = graph.unheard();
  for (const EventType& type : vocabulary().types()) {
    unheard.erase({type.source, type.scope});
  }
  return unheard;
}

std::set<SourceGraph::Subscription> Model::expectedSubscriptions() const {
  std::vector<evidence::Span> spans;
  for (const RecordingInfo& recording : recordings) {
    spans.push_back({recording.start, recording.end, recording.robot_start});
  }
  std::set<SourceGraph::Subscription> expected;
  if (evidence::numberOfStarts(spans, toNanoseconds(tuning.start_time)) < kFewestStarts) {
    return expected;
  }
  std::set<std::string> components;
  for (const EventType& type : vocabulary().types()) {
    components.insert(type.source);
  }
  for (const auto& [subscription, in_recordings] : graph.lasting()) {
    if (in_recordings == recordings.size() && components.count(subscription.first) > 0) {
      expected.insert(subscription);
    }
  }
  return expected;
}

void Model::watch() {
  if (!hasEvidence()) {
    throw std::invalid_argument("loaded without its counts");
  }
  evidence::leaveOutSilentPairs(evidence, graph, tuning);
  watched = evidence::watch(evidence[0], evidence[1], graph, tuning);
}

void Model::dropCounts() {
  paper::DelayStatistics types(statistics.binning());
  for (EventId id = 0; id < vocabulary().size(); ++id) {
    types.countEvent(types.intern(vocabulary().at(id)), statistics.eventCount(id));
  }
  statistics = std::move(types);
  evidence = {};
}

std::optional<double> Model::threshold() const {
  return paper_calibration ? std::optional(paper_calibration->threshold) : std::nullopt;
}

std::optional<evidence::Limits> Model::limits() const {
  return calibration ? std::optional(calibration->limits) : std::nullopt;
}

std::vector<evidence::Coverage> Model::coverage() const {
  if (!calibration) {
    return {};
  }
  requireWatched();
  return evidence::coverageOf(evidence::Model(watched), calibration->limits,
                              calibration->relations, window, !graph.empty());
}

std::unique_ptr<Judge> Model::makeJudge(std::shared_ptr<const Vocabulary> heard) const {
  requireWatched();
  return evidence::makeJudge(std::make_shared<const evidence::Model>(watched), limits(), window,
                             std::make_shared<const SourceGraph>(graph), std::move(heard));
}

}  // namespace self_awareness::core
