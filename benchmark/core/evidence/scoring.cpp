// Measures the evidence detector: taking in an event, closing a window; training; size in memory.

#include <benchmark/benchmark.h>

#include <array>
#include <map>
#include <memory>

#include "core/evidence/channel/scorer.h"
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

std::array<evidence::Statistics, 2> trainedHalves(std::size_t types) {
  std::array<evidence::Statistics, 2> halves = {emptyStatistics<evidence::Statistics>(types),
                                                emptyStatistics<evidence::Statistics>(types)};
  SyntheticSystem system(types);
  for (evidence::Statistics& half : halves) {
    evidence::Trainer trainer(half, kWindow);
    trainFor(kTrainingOfHalf, system, trainer);
  }
  return halves;
}

struct Trained {
  std::shared_ptr<const evidence::Model> model;
  std::size_t bytes = 0;  // of the model and of a scorer
};

// Google Benchmark calls a function several times; the models are trained only once.
const Trained& trained(std::size_t types) {
  static std::map<std::size_t, Trained> all;
  Trained& entry = all[types];
  if (!entry.model) {
    const std::array<evidence::Statistics, 2> halves = trainedHalves(types);
    const evidence::Watched watched = evidence::watch(halves[0], halves[1]);
    const std::size_t before = allocatedBytes();
    entry.model = std::make_shared<const evidence::Model>(watched);
    const evidence::Scorer scorer(entry.model, kWindow);
    entry.bytes = allocatedBytes() - before;
  }
  return entry;
}

void scoreEvidence(benchmark::State& state) {
  const auto types = static_cast<std::size_t>(state.range(0));
  const Trained& entry = trained(types);
  EventLoop events = loopOfEvents(types);
  evidence::Scorer scorer(entry.model, kWindow);
  for (std::size_t i = 0; i < events.size(); ++i) {
    scorer.add(events.next());  // after this, all types have been seen
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(scorer.add(events.next()));
  }
  state.counters["bytes"] = static_cast<double>(entry.bytes);
}
BENCHMARK(scoreEvidence)->ArgsProduct({kSizes});

void closeWindowEvidence(benchmark::State& state) {
  const auto types = static_cast<std::size_t>(state.range(0));
  EventLoop events = loopOfEvents(types);
  evidence::Scorer scorer(trained(types).model, kWindow);
  core::Event last;
  for (std::size_t i = 0; i < events.size(); ++i) {
    last = events.next();
    scorer.add(last);
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(scorer.closeWindow(last.stamp + 1));
  }
}
BENCHMARK(closeWindowEvidence)->ArgsProduct({kSizes});

void trainEvidence(benchmark::State& state) {
  const auto types = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    auto statistics = emptyStatistics<evidence::Statistics>(types);
    evidence::Trainer trainer(statistics, kWindow);
    SyntheticSystem system(types);
    const TrainingRun run = trainFor(2 * kTrainingOfHalf, system, trainer);
    state.SetIterationTime(run.seconds);
    state.counters["events"] = static_cast<double>(run.events);
  }
}
BENCHMARK(trainEvidence)
    ->ArgsProduct({kSizes})
    ->Repetitions(1)
    ->UseManualTime()
    ->MinTime(0.2)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace self_awareness::benchmarks

BENCHMARK_MAIN();
