#include "self_awareness/core/model.h"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "core/evidence/count/starts.h"
#include "core/evidence/watch/silent_pairs.h"
#include "self_awareness/core/evidence/judge.h"

namespace self_awareness::core {
namespace {

// What all recordings of one start have, somebody may have started by hand.
constexpr std::size_t kFewestStarts = 2;

void requireCounts(const Model& model) {
  if (!model.hasEvidence() && (model.isWatched() || !model.hasDelays())) {
    throw std::invalid_argument("loaded without its counts");
  }
}

std::int64_t horizon(const paper::Binning& binning) {
  return binning.horizon_bins * binning.bin_size;
}

// Throws std::invalid_argument unless the two are the same.
// @param none what a 0 means, in words
void requireSame(const std::string& what, std::int64_t one, std::int64_t other,
                 const std::string& none) {
  const auto text = [&](std::int64_t time) {
    std::ostringstream seconds;
    seconds << std::setprecision(12) << toSeconds(time) << " s";
    return time == 0 ? none : seconds.str();
  };
  if (one != other) {
    throw std::invalid_argument("another " + what + ": " + text(other) + ", not " + text(one));
  }
}

void addTo(SourceGraph& graph, const SourceGraph& other) {
  for (const auto& [publisher, topic, subscriber] : other.edges()) {
    graph.connect(publisher, topic, subscriber);
  }
  for (const auto& [source, host] : other.hosts()) {
    graph.place(source, host);
  }
  for (const SourceGraph::Publication& publication : other.unheard()) {
    graph.addUnheard(publication);
  }
  for (const auto& [subscription, in_recordings] : other.lasting()) {
    graph.addLasting(subscription, in_recordings);
  }
}

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

void Model::dropWatched() {
  watched = {};
  findings.clear();
  calibration.reset();
  paper_calibration.reset();
}

void Model::add(const Model& other) {
  requireCounts(*this);
  requireCounts(other);
  requireSame("length of the windows", window, other.window, "0 s");
  const paper::Binning& binning = statistics.binning();
  const paper::Binning& others = other.statistics.binning();
  requireSame("bin size", binning.bin_size, others.bin_size, "0 s");
  requireSame("horizon", horizon(binning), horizon(others), "none");
  if (hasEvidence() != other.hasEvidence() || hasDelays() != other.hasDelays()) {
    throw std::invalid_argument("trained for another detector: " + other.detectors() + ", not " +
                                detectors() + "; train both with the same --detector");
  }
  statistics.merge(other.statistics);
  evidence::merge(evidence, onlyHalf(), other.evidence, other.onlyHalf());
  addTo(graph, other.graph);
  recordings.insert(recordings.end(), other.recordings.begin(), other.recordings.end());
  if (tuning != other.tuning) {
    tuning = {};
  }
  dropWatched();
  stamp = std::max(stamp, other.stamp);
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
