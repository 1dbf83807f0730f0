#include "model_parts.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "model_fields.h"
#include "self_awareness/core/evidence/channel/track.h"

namespace self_awareness::ros1 {
namespace {

namespace evidence = core::evidence;
using core::EventId;

constexpr char kOther[] = "its evidence does not fit its event types";
constexpr std::size_t kBitsOfByte = 8;

bool isFilled(std::uint32_t count) {
  return count > 0;
}

void writeEventTypes(const core::paper::DelayStatistics& statistics, ByteWriter& bytes) {
  bytes(statistics.binning().bin_size, statistics.binning().horizon_bins,
        statistics.vocabulary().types());
  for (EventId id = 0; id < statistics.vocabulary().size(); ++id) {
    bytes(statistics.eventCount(id));
  }
}

core::paper::DelayStatistics readEventTypes(ByteReader& bytes) {
  core::paper::Binning binning;
  std::vector<core::EventType> types;
  bytes(binning.bin_size, binning.horizon_bins, types);
  check(types.size() <= kMostEventTypes, "it has too many event types");
  core::paper::DelayStatistics statistics(binning);
  for (const core::EventType& type : types) {
    const std::size_t before = statistics.vocabulary().size();
    check(statistics.intern(type) == before, "an event type occurs twice");
  }
  for (EventId id = 0; id < types.size(); ++id) {
    std::uint64_t count = 0;
    bytes(count);
    statistics.countEvent(id, count);
  }
  return statistics;
}

void writeTuning(const evidence::Tuning& tuning, ByteWriter& bytes) {
  std::map<std::string, double> numbers;
  for (const evidence::TuningNumber& number : evidence::tuningNumbers()) {
    numbers[number.name] = tuning.*number.value;
  }
  bytes(numbers, tuning.without);
}

/// What the bytes lack has its default; what this version does not know is left out.
evidence::Tuning readTuning(ByteReader& bytes) {
  evidence::Tuning tuning;
  std::map<std::string, double> numbers;
  bytes(numbers, tuning.without);
  for (const evidence::TuningNumber& number : evidence::tuningNumbers()) {
    const auto given = numbers.find(number.name);
    if (given != numbers.end()) {
      evidence::set(tuning, number.name, given->second);
    }
  }
  for (auto name = tuning.without.begin(); name != tuning.without.end();) {
    name = evidence::channelNamed(*name) == nullptr ? tuning.without.erase(name) : std::next(name);
  }
  return tuning;
}

void writeWatched(const evidence::Watched& watched, ByteWriter& bytes) {
  bytes(watched.tracks.size());
  for (const evidence::Track& track : watched.tracks) {
    bytes(channelName(track), track.to, track.from);
  }
  for (const evidence::Statistics& half : watched.halves) {
    writeCounts(half, bytes);
    for (EventId id = 0; id < half.size(); ++id) {
      writePairs(half, id, bytes);
    }
  }
}

/// @param names of channels, of the tracks whose channel this version does not have
void readWatched(ByteReader& bytes, const core::Vocabulary& vocabulary, evidence::Watched& watched,
                 std::set<std::string>& names) {
  for (std::size_t left = bytes.length(sizeof(evidence::Track)); left > 0; --left) {
    std::string name;
    evidence::Track& track = watched.tracks.emplace_back();
    bytes(name, track.to, track.from);
    track.channel = evidence::channelNamed(name);
    if (track.channel == nullptr) {
      names.insert(name);
    }
  }
  for (evidence::Statistics& half : watched.halves) {
    half = readCounts(bytes, vocabulary);
    for (EventId id = 0; id < half.size(); ++id) {
      readPairs(bytes, id, half);
    }
  }
}

void readGraph(ByteReader& bytes, core::SourceGraph& graph) {
  std::set<core::SourceGraph::Edge> edges;
  std::map<std::string, std::string> hosts;
  std::set<core::SourceGraph::Publication> unheard;
  std::map<core::SourceGraph::Subscription, std::size_t> lasting;
  bytes(edges, hosts, unheard, lasting);
  for (const core::SourceGraph::Edge& edge : edges) {
    graph.connect(edge.publisher, edge.topic, edge.subscriber);
  }
  for (const auto& [source, host] : hosts) {
    graph.place(source, host);
  }
  for (const core::SourceGraph::Publication& publication : unheard) {
    graph.addUnheard(publication);
  }
  for (const auto& [subscription, recordings] : lasting) {
    graph.addLasting(subscription, recordings);
  }
}

}  // namespace

void writeModel(const TrainedModel& model, ByteWriter& bytes) {
  bytes(model.stamp, model.encoding, model.window);
  writeEventTypes(model.statistics, bytes);
  writeTuning(model.tuning, bytes);
  bytes(model.isWatched());
  if (model.isWatched()) {
    writeWatched(model.watched, bytes);
  }
  bytes(model.graph.edges(), model.graph.hosts(), model.graph.unheard(), model.graph.lasting(),
        model.recordings, model.findings, model.paper_calibration, model.calibration);
}

TrainedModel readModel(ByteReader& bytes) {
  TrainedModel model;
  bytes(model.stamp, model.encoding, model.window);
  model.statistics = readEventTypes(bytes);
  model.tuning = readTuning(bytes);
  model.watched.tuning = model.tuning;
  bool is_watched = false;
  bytes(is_watched);
  if (is_watched) {
    readWatched(bytes, model.vocabulary(), model.watched, model.left_out);
  }
  readGraph(bytes, model.graph);
  bytes(model.recordings, model.findings, model.paper_calibration, model.calibration);
  for (evidence::LimitFinder::Recording& recording : model.findings) {
    recording.trained_on = true;
  }
  checkModel(model);
  removeUnknownTracks(model);
  core::evidence::checkTracks(model.watched.tracks, model.vocabulary().size());
  return model;
}

void writeDelays(const core::paper::DelayStatistics& statistics, EventId to, ByteWriter& bytes) {
  for (EventId from = 0; from < statistics.vocabulary().size(); ++from) {
    bytes(statistics.pair(from, to).entries());
  }
}

void readDelays(ByteReader& bytes, EventId to, core::paper::DelayStatistics& statistics) {
  core::paper::Histogram::Entries entries;
  for (EventId from = 0; from < statistics.vocabulary().size(); ++from) {
    bytes(entries);
    std::int64_t least = 0;
    for (const core::paper::Histogram::Entry& entry : entries) {
      check(entry.count > 0 && entry.bin >= least &&
                entry.bin < std::numeric_limits<std::int64_t>::max(),
            "a histogram has an impossible bin");
      least = entry.bin + 1;
    }
    statistics.pair(from, to).add(entries);
  }
}

void writeCounts(const evidence::Statistics& statistics, ByteWriter& bytes) {
  bytes(statistics.rateWindows(), statistics.duration(), statistics.recordings());
  for (EventId id = 0; id < statistics.size(); ++id) {
    bytes(statistics.type(id));
  }
}

evidence::Statistics readCounts(ByteReader& bytes, const core::Vocabulary& vocabulary) {
  evidence::Statistics statistics;
  for (const core::EventType& type : vocabulary.types()) {
    statistics.intern(type);
  }
  std::uint64_t rate_windows = 0;
  std::int64_t duration = 0;
  std::vector<evidence::Statistics::Recording> recordings;
  bytes(rate_windows, duration, recordings);
  statistics.addRateWindows(rate_windows);
  statistics.addDuration(duration);
  for (evidence::Statistics::Recording& recording : recordings) {
    check(recording.events.size() == recording.longest_gaps.size() &&
              recording.events.size() == recording.firsts.size(),
          "its recordings do not fit its event types");
    statistics.addRecording(std::move(recording));
  }
  for (EventId id = 0; id < vocabulary.size(); ++id) {
    bytes(statistics.type(id));
  }
  checkCounts(statistics);
  return statistics;
}

void writePairs(const evidence::Statistics& statistics, EventId id, ByteWriter& bytes) {
  const evidence::Partners& partners = statistics.partners(id);
  const auto isEmpty = [&](std::size_t k) {
    return partners.answers(k) == 0 && partners.total(k) == 0;
  };
  std::size_t number = 0;
  for (std::size_t k = 0; k < partners.size(); ++k) {
    number += isEmpty(k) ? 0 : 1;
  }
  bytes(number);
  for (std::size_t k = 0; k < partners.size(); ++k) {
    if (!isEmpty(k)) {
      const evidence::Partner partner = partners.at(k);
      const auto first = std::find_if(partner.delays.begin(), partner.delays.end(), isFilled);
      const auto end =
          std::find_if(partner.delays.rbegin(), std::make_reverse_iterator(first), isFilled)
              .base();
      bytes(partner.id, partner.answers, static_cast<std::size_t>(first - partner.delays.begin()),
            std::vector<std::uint32_t>(first, end));
    }
  }
  const evidence::SumOfDelays& left_out = statistics.type(id).left_out;
  bytes(left_out != evidence::SumOfDelays{} ? std::optional(left_out) : std::nullopt);
  std::vector<std::uint8_t> pairs;  // bit by bit
  for (EventId from = 0; from < statistics.size(); ++from) {
    if (statistics.leftOut().contains(id, from)) {
      pairs.resize(from / kBitsOfByte + 1);
      pairs.back() |= static_cast<std::uint8_t>(1U << from % kBitsOfByte);
    }
  }
  bytes(pairs);
}

void readPairs(ByteReader& bytes, EventId id, evidence::Statistics& statistics) {
  evidence::Partners partners;
  std::vector<std::uint32_t> counts;
  for (std::size_t left = bytes.length(sizeof(evidence::Partner)); left > 0; --left) {
    evidence::Partner partner;
    std::uint64_t first = 0;
    bytes(partner.id, partner.answers, first, counts);
    check(first <= evidence::kDelayBins && counts.size() <= evidence::kDelayBins - first,
          "its evidence has an impossible bin");
    check(partner.answers <= std::numeric_limits<std::int64_t>::max(), kOther);
    std::copy(counts.begin(), counts.end(),
              partner.delays.begin() + static_cast<std::ptrdiff_t>(first));
    partners.append(partner);
  }
  statistics.setPartners(id, std::move(partners));
  check(statistics.total(id, id) <= statistics.type(id).gaps,
        "its evidence has more delays than gaps");
  std::optional<evidence::SumOfDelays> left_out;
  std::vector<std::uint8_t> pairs;
  bytes(left_out, pairs);
  statistics.type(id).left_out = left_out.value_or(evidence::SumOfDelays{});
  for (std::size_t k = 0; k < pairs.size() * kBitsOfByte; ++k) {
    if ((pairs[k / kBitsOfByte] >> k % kBitsOfByte & 1U) != 0) {
      check(k < statistics.size(), kOther);
      statistics.leaveOut(static_cast<EventId>(k), id);
    }
  }
}

namespace {

/// Of the package, before all else.
std::string version() {
  ByteWriter bytes;
  bytes(versionOf(kModelFile));
  const std::vector<std::uint8_t> written = bytes.take();
  return {written.begin(), written.end()};
}

TrainedModel readAll(ByteReader& bytes) {
  TrainedModel model = readModel(bytes);
  bool has_delays = false;
  bool has_evidence = false;
  bytes(model.version, has_delays, has_evidence);
  for (core::EventId to = 0; has_delays && to < model.vocabulary().size(); ++to) {
    readDelays(bytes, to, model.statistics);
  }
  for (std::size_t half = 0; has_evidence && half < model.evidence.size(); ++half) {
    model.evidence[half] = readCounts(bytes, model.vocabulary());
    for (core::EventId id = 0; id < model.vocabulary().size(); ++id) {
      readPairs(bytes, id, model.evidence[half]);
    }
  }
  check(bytes.done(), "there is more than belongs to it");
  return model;
}

}  // namespace

std::string toBytes(const TrainedModel& model) {
  ByteWriter bytes;
  writeModel(model, bytes);
  bytes(model.version, model.hasDelays(), model.hasEvidence());
  for (core::EventId to = 0; model.hasDelays() && to < model.vocabulary().size(); ++to) {
    writeDelays(model.statistics, to, bytes);
  }
  for (std::size_t half = 0; model.hasEvidence() && half < model.evidence.size(); ++half) {
    writeCounts(model.evidence[half], bytes);
    for (core::EventId id = 0; id < model.vocabulary().size(); ++id) {
      writePairs(model.evidence[half], id, bytes);
    }
  }
  const std::vector<std::uint8_t> all = bytes.take();
  return version().append(all.begin(), all.end());
}

TrainedModel fromBytes(const std::string& bytes) {
  const std::string expected = version();
  if (bytes.compare(0, expected.size(), expected) != 0) {
    throw std::invalid_argument("a model of another version of self_awareness");
  }
  // They are of this program: they may take any memory.
  ByteReader reader(reinterpret_cast<const std::uint8_t*>(bytes.data()) + expected.size(),
                    bytes.size() - expected.size(), kModelFile.format,
                    std::numeric_limits<std::size_t>::max());
  try {
    return readAll(reader);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("a damaged model: ") + error.what());
  }
}

}  // namespace self_awareness::ros1
