// Measures the evidence detector: taking in an event, compared with the bare look-ups; closing a
// window; training; size in memory.

#include <benchmark/benchmark.h>

#include <array>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "allocated_bytes.h"
#include "core/evidence/channel/scorer.h"
#include "core/evidence/count/log_bins.h"
#include "event_loop.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/evidence/count/trainer.h"
#include "synthetic_system.h"

namespace self_awareness::benchmarks {
namespace {

namespace evidence = core::evidence;
using core::kNanosecondsPerSecond;

constexpr std::int64_t kTrainingOfHalf = 50 * kNanosecondsPerSecond;
constexpr std::int64_t kWindow = kNanosecondsPerSecond / 10;

evidence::Statistics emptyStatistics(std::size_t types) {
  evidence::Statistics statistics;
  for (core::EventId id = 0; id < types; ++id) {
    statistics.intern(SyntheticSystem::type(id));
  }
  return statistics;
}

std::array<evidence::Statistics, 2> trainedHalves(std::size_t types) {
  std::array<evidence::Statistics, 2> halves = {emptyStatistics(types), emptyStatistics(types)};
  SyntheticSystem system(types);
  for (evidence::Statistics& half : halves) {
    evidence::Trainer trainer(half, kWindow);
    trainFor(kTrainingOfHalf, system, trainer);
  }
  return halves;
}

struct Trained {
  evidence::Watched watched;
  std::shared_ptr<const evidence::Model> model;
  std::size_t bytes = 0;  // of the model and of a scorer
};

// Google Benchmark calls a function several times; the models are trained only once.
const Trained& trained(std::size_t types) {
  static std::map<std::size_t, Trained> all;
  Trained& entry = all[types];
  if (!entry.model) {
    const std::array<evidence::Statistics, 2> halves = trainedHalves(types);
    entry.watched = evidence::watch(halves[0], halves[1]);
    const std::size_t before = allocatedBytes();
    entry.model = std::make_shared<const evidence::Model>(entry.watched);
    const evidence::Scorer scorer(entry.model, kWindow);
    entry.bytes = allocatedBytes() - before;
  }
  return entry;
}

// Event types since whose last event the scorer looks at the delay, by the type of the event.
using Terms = std::vector<std::vector<core::EventId>>;

Terms termsOf(const evidence::Model& model) {
  Terms terms(model.size());
  for (const evidence::Track& track : model.tracks()) {
    const std::string channel = evidence::channelName(track);
    if (channel == "own gaps" || channel == "pairs") {
      terms[track.to].push_back(track.from);
    }
  }
  return terms;
}

// Mean number of terms of an event, over the events of a round.
double termsPerEvent(const Terms& terms, EventLoop& events) {
  std::size_t number = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    number += terms[events.next().id].size();
  }
  return static_cast<double>(number) / static_cast<double>(events.size());
}

void scoreEvidence(benchmark::State& state) {
  const auto types = static_cast<std::size_t>(state.range(0));
  const Trained& entry = trained(types);
  EventLoop events = loopOfEvents(types);
  state.counters["terms"] = termsPerEvent(termsOf(*entry.model), events);
  evidence::Scorer scorer(entry.model, kWindow);
  for (std::size_t i = 0; i < events.size(); ++i) {
    scorer.add(events.next());  // after this, all types have been seen
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(scorer.add(events.next()));
  }
}
BENCHMARK(scoreEvidence)->ArgsProduct({kSizes});

// Looks up what the terms of an event need, and does nothing else: when the other event came, the
// sums of the pair, and how surprising a delay is.
void lookUpEvidence(benchmark::State& state) {
  struct Seen {
    double stamp = 1;
    double number = 1;
  };
  struct Pair {
    std::array<double, 6> cells{1};
  };
  struct Term {
    core::EventId other;
    std::uint32_t number;
    std::uint32_t bin;
  };
  const auto types = static_cast<std::size_t>(state.range(0));
  const Terms terms = termsOf(*trained(types).model);
  EventLoop events = loopOfEvents(types);
  state.counters["terms"] = termsPerEvent(terms, events);
  std::mt19937 random(1);
  std::vector<std::vector<Term>> delays(types);
  std::size_t pairs = 0;
  for (core::EventId id = 0; id < types; ++id) {
    for (const core::EventId from : terms[id]) {
      // Most delays of a pair are in a few bins.
      delays[id].push_back({from, static_cast<std::uint32_t>(pairs++),
                            static_cast<std::uint32_t>(random() % evidence::log_bins::kBins)});
    }
  }
  const std::vector<Seen> seen(types);
  const std::vector<Pair> of_pairs(pairs);
  const std::vector<std::array<double, evidence::log_bins::kBins>> surprises(pairs);
  double sum = 0;
  for (auto _ : state) {
    const core::EventId id = events.next().id;
    for (const Term& term : delays[id]) {
      sum += seen[term.other].stamp + of_pairs[term.number].cells[0] +
             surprises[term.number][term.bin];
    }
  }
  benchmark::DoNotOptimize(sum);
}
BENCHMARK(lookUpEvidence)->ArgsProduct({kSizes});

void closeWindowEvidence(benchmark::State& state) {
  const auto types = static_cast<std::size_t>(state.range(0));
  const Trained& entry = trained(types);
  EventLoop events = loopOfEvents(types);
  evidence::Scorer scorer(entry.model, kWindow);
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
    evidence::Statistics statistics = emptyStatistics(types);
    evidence::Trainer trainer(statistics, kWindow);
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

void chooseEvidence(benchmark::State& state) {
  const std::array<evidence::Statistics, 2> halves =
      trainedHalves(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(evidence::watch(halves[0], halves[1]));
  }
}
BENCHMARK(chooseEvidence)->ArgsProduct({kSizes})->Repetitions(1)->Unit(benchmark::kMillisecond);

void loadEvidence(benchmark::State& state) {
  const Trained& entry = trained(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    evidence::Model model(entry.watched);
    benchmark::DoNotOptimize(model);
  }
  state.counters["bytes"] = static_cast<double>(entry.bytes);
}
BENCHMARK(loadEvidence)->ArgsProduct({kSizes})->Repetitions(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace self_awareness::benchmarks

BENCHMARK_MAIN();
