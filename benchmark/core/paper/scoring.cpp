// Measures the paper's detector: scoring an event, compared with the bare look-ups; training; size
// in memory.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <memory>
#include <vector>

#include "core/paper/delay_trainer.h"
#include "core/paper/scorer.h"
#include "event_loop.h"
#include "self_awareness/core/paper/delay_statistics.h"
#include "self_awareness/core/paper/model.h"
#include "synthetic_system.h"

namespace self_awareness::benchmarks {
namespace {

namespace paper = core::paper;
using core::kNanosecondsPerSecond;

constexpr std::int64_t kTraining = 100 * kNanosecondsPerSecond;
const paper::Binning kBinning{10000000, 0};

struct Trained {
  std::shared_ptr<const paper::Model> model;
  std::size_t bytes = 0;  // of the model
};

// Google Benchmark calls a function several times; the models are trained only once.
const Trained& trained(std::size_t types) {
  static std::map<std::size_t, Trained> all;
  Trained& entry = all[types];
  if (!entry.model) {
    auto statistics = emptyStatistics<paper::DelayStatistics>(types, kBinning);
    paper::DelayTrainer trainer(statistics);
    SyntheticSystem system(types);
    trainFor(kTraining, system, trainer);
    const std::size_t before = allocatedBytes();
    entry.model = std::make_shared<const paper::Model>(statistics);
    entry.bytes = allocatedBytes() - before;
  }
  return entry;
}

void scorePaper(benchmark::State& state) {
  const auto types = static_cast<std::size_t>(state.range(0));
  paper::Scorer scorer(trained(types).model);
  EventLoop events = loopOfEvents(types);
  for (std::size_t i = 0; i < events.size(); ++i) {
    scorer.score(events.next());  // after this, all types are tracked
  }
  double sum = 0;
  for (auto _ : state) {
    sum += scorer.score(events.next()).score;
  }
  benchmark::DoNotOptimize(sum);
  const auto& seen = scorer.lastSeen();
  state.counters["terms"] = static_cast<double>(std::count_if(
      seen.begin(), seen.end(), [](const auto& stamp) { return stamp.has_value(); }));
  state.counters["bytes"] = static_cast<double>(trained(types).bytes);
}
BENCHMARK(scorePaper)->ArgsProduct({kSizes});

// Does the same number of look-ups for the same events and delays in a table of the same size, and
// nothing else.
void lookUpPaper(benchmark::State& state) {
  const auto types = static_cast<std::size_t>(state.range(0));
  EventLoop events = loopOfEvents(types);
  const std::size_t cells =
      std::max<std::size_t>(trained(types).bytes / (types * types * sizeof(std::uint32_t)), 1);
  std::vector<std::uint32_t> table(types * types * cells, 1);
  std::vector<std::uint32_t> places;  // in the row of the event
  std::vector<std::int64_t> last_seen(types, 0);
  places.reserve(types * events.size());
  for (const bool recorded : {false, true}) {
    for (std::size_t i = 0; i < events.size(); ++i) {
      const core::Event event = events.next();
      for (std::size_t from = 0; from < types && recorded; ++from) {
        const auto bin = static_cast<std::size_t>(kBinning.bin(event.stamp - last_seen[from]));
        places.push_back(static_cast<std::uint32_t>(from * cells + std::min(bin, cells - 1)));
      }
      last_seen[event.id] = event.stamp;
    }
  }
  std::uint64_t sum = 0;
  for (auto _ : state) {
    const std::uint32_t* place = places.data() + events.position() * types;
    const std::uint32_t* row = table.data() + events.next().id * types * cells;
    for (std::size_t from = 0; from < types; ++from) {
      sum += row[place[from]];
    }
  }
  benchmark::DoNotOptimize(sum);
  state.counters["terms"] = static_cast<double>(types);
}
BENCHMARK(lookUpPaper)->ArgsProduct({kSizes});

void trainPaper(benchmark::State& state) {
  const auto types = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    auto statistics = emptyStatistics<paper::DelayStatistics>(types, kBinning);
    paper::DelayTrainer trainer(statistics);
    SyntheticSystem system(types);
    const TrainingRun run = trainFor(kTraining, system, trainer);
    state.SetIterationTime(run.seconds);
    state.counters["events"] = static_cast<double>(run.events);
  }
}
BENCHMARK(trainPaper)
    ->ArgsProduct({kSizes})
    ->Repetitions(1)
    ->UseManualTime()
    ->MinTime(0.2)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace self_awareness::benchmarks
