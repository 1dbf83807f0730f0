// The evidence detector: taking in an event, against the bare look-ups; closing a window;
// training; its size in memory.

#include <benchmark/benchmark.h>

#include <array>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "allocated_bytes.h"
#include "event_loop.h"
#include "self_awareness/core/evidence_model.h"
#include "self_awareness/core/evidence_scorer.h"
#include "self_awareness/core/evidence_statistics.h"
#include "self_awareness/core/log_bins.h"
#include "synthetic_system.h"

namespace self_awareness::benchmarks {
namespace {

using core::kNanosecondsPerSecond;

constexpr std::int64_t kTrainingOfHalf = 50 * kNanosecondsPerSecond;
constexpr std::int64_t kWindow = kNanosecondsPerSecond / 10;

core::EvidenceStatistics emptyStatistics(std::size_t types) {
  core::EvidenceStatistics statistics;
  for (core::EventId id = 0; id < types; ++id) {
    statistics.intern(SyntheticSystem::type(id));
  }
  return statistics;
}

std::array<core::EvidenceStatistics, 2> trainedHalves(std::size_t types) {
  std::array<core::EvidenceStatistics, 2> halves = {emptyStatistics(types),
                                                    emptyStatistics(types)};
  SyntheticSystem system(types);
  for (core::EvidenceStatistics& half : halves) {
    core::EvidenceTrainer trainer(half, kWindow);
    trainFor(kTrainingOfHalf, system, trainer);
  }
  return halves;
}

struct Trained {
  std::array<core::EvidenceStatistics, 2> halves;
  std::shared_ptr<const core::EvidenceModel> model;
  std::size_t bytes = 0;
};

// Google Benchmark calls a function several times; models are the same every time.
const Trained& trained(std::size_t types) {
  static std::map<std::size_t, Trained> all;
  Trained& entry = all[types];
  if (!entry.model) {
    entry.halves = trainedHalves(types);
    const std::size_t before = allocatedBytes();
    entry.model = std::make_shared<const core::EvidenceModel>(entry.halves[0], entry.halves[1]);
    entry.bytes = allocatedBytes() - before;
  }
  return entry;
}

// Tracks that an event of a type makes look at another type, by the event's type.
std::vector<std::vector<std::size_t>> tracksByEvent(const core::EvidenceModel& model) {
  std::vector<std::vector<std::size_t>> tracks(model.size());
  for (std::size_t track = 0; track < model.tracks().size(); ++track) {
    const core::Track& watched = model.tracks()[track];
    if (watched.channel == core::Channel::kAnswer) {
      tracks[watched.from].push_back(track);
    } else if (watched.channel == core::Channel::kDelay ||
               watched.channel == core::Channel::kSlowDelay) {
      tracks[watched.to].push_back(track);
    }
  }
  return tracks;
}

// Terms of an event, the mean over the events of a round.
double termsPerEvent(const std::vector<std::vector<std::size_t>>& tracks, EventLoop& events) {
  std::size_t terms = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    terms += tracks[events.next().id].size();
  }
  return static_cast<double>(terms) / static_cast<double>(events.size());
}

void scoreEvidence(benchmark::State& state) {
  const auto types = static_cast<std::size_t>(state.range(0));
  const Trained& entry = trained(types);
  EventLoop events = loopOfEvents(types);
  state.counters["terms"] = termsPerEvent(tracksByEvent(*entry.model), events);
  core::EvidenceScorer scorer(entry.model, kWindow);
  for (std::size_t i = 0; i < events.size(); ++i) {
    scorer.add(events.next());  // from now on all types have been seen
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(scorer.add(events.next()));
  }
}
BENCHMARK(scoreEvidence)->ArgsProduct({kSizes});

// The same number of look-ups in a table of a row of bins a track, and nothing else.
void lookUpEvidence(benchmark::State& state) {
  const auto types = static_cast<std::size_t>(state.range(0));
  const auto tracks = tracksByEvent(*trained(types).model);
  EventLoop events = loopOfEvents(types);
  state.counters["terms"] = termsPerEvent(tracks, events);
  const std::size_t bins = core::log_bins::kBins;
  std::vector<double> table(trained(types).model->tracks().size() * bins, 1);
  std::mt19937 random(1);
  std::vector<std::uint32_t> places;
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < events.size(); ++i) {
    starts.push_back(places.size());
    for (const std::size_t track : tracks[events.next().id]) {
      places.push_back(static_cast<std::uint32_t>(track * bins + random() % bins));
    }
  }
  starts.push_back(places.size());
  double sum = 0;
  for (auto _ : state) {
    const std::size_t event = events.position();
    for (std::size_t i = starts[event]; i < starts[event + 1]; ++i) {
      sum += table[places[i]];
    }
    events.next();
  }
  benchmark::DoNotOptimize(sum);
}
BENCHMARK(lookUpEvidence)->ArgsProduct({kSizes});

void closeWindowEvidence(benchmark::State& state) {
  const auto types = static_cast<std::size_t>(state.range(0));
  const Trained& entry = trained(types);
  EventLoop events = loopOfEvents(types);
  core::EvidenceScorer scorer(entry.model, kWindow);
  core::Event last;
  for (std::size_t i = 0; i < events.size(); ++i) {
    last = events.next();
    scorer.add(last);
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(scorer.closeWindow(last.stamp + 1));
  }
  state.counters["tracks"] = static_cast<double>(entry.model->tracks().size());
}
BENCHMARK(closeWindowEvidence)->ArgsProduct({kSizes});

void trainEvidence(benchmark::State& state) {
  const auto types = static_cast<std::size_t>(state.range(0));
  const std::size_t before = allocatedBytes();
  for (auto _ : state) {
    core::EvidenceStatistics statistics = emptyStatistics(types);
    core::EvidenceTrainer trainer(statistics, kWindow);
    SyntheticSystem system(types);
    const TrainingRun first = trainFor(2 * kTrainingOfHalf, system, trainer);
    state.SetIterationTime(first.seconds);
    state.counters["events"] = static_cast<double>(first.events);
    state.counters["bytes"] = static_cast<double>(allocatedBytes() - before);
    trainFor(2 * kTrainingOfHalf, system, trainer);
    state.counters["bytes_of_twice"] = static_cast<double>(allocatedBytes() - before);
  }
}
BENCHMARK(trainEvidence)
    ->ArgsProduct({kSizes})
    ->Repetitions(1)
    ->UseManualTime()
    ->MinTime(0.2)
    ->Unit(benchmark::kMillisecond);

void loadEvidence(benchmark::State& state) {
  const Trained& entry = trained(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    core::EvidenceModel model(entry.halves[0], entry.halves[1]);
    benchmark::DoNotOptimize(model);
  }
  state.counters["bytes"] = static_cast<double>(entry.bytes);
}
BENCHMARK(loadEvidence)->ArgsProduct({kSizes})->Repetitions(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace self_awareness::benchmarks

BENCHMARK_MAIN();
