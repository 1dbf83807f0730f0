#include "core/paper/delay_trainer.h"

#include <array>
#include <cstddef>

#include "self_awareness/core/stream/clock.h"

namespace self_awareness::core::paper {
namespace {

// Number of pairs that are worked on together.
constexpr std::size_t kPairsAtOnce = 64;

}  // namespace

DelayTrainer::DelayTrainer(DelayStatistics& statistics)
    : statistics_(statistics), bins_(statistics.binning()) {}

void DelayTrainer::startRecording() {
  seen_.clear();
  last_stamp_.reset();
}

void DelayTrainer::add(const Event& event) {
  if (last_stamp_ && isClockStep(*last_stamp_, event.stamp)) {
    startRecording();
  }
  last_stamp_ = event.stamp;
  statistics_.countEvent(event.id);
  const std::uint64_t mark = bins_.mark(event.stamp);
  Histogram* const pairs = statistics_.pairsTo(event.id).data();
  // All slots of a block are fetched before the first one is needed: so they arrive together.
  std::array<EventId, kPairsAtOnce> block;
  std::array<std::int64_t, kPairsAtOnce> bins;
  EventId next = 0;
  while (next < seen_.size()) {
    std::size_t terms = 0;
    for (; next < seen_.size() && terms < kPairsAtOnce; ++next) {
      if (seen_.contains(next)) {
        block[terms] = next;
        bins[terms] = bins_.bin(seen_.marks()[next], mark);
        pairs[next].prefetch(bins[terms]);
        ++terms;
      }
    }
    for (std::size_t i = 0; i < terms; ++i) {
      pairs[block[i]].add(bins[i]);
    }
  }
  seen_.resize(statistics_.vocabulary().size());
  seen_.add(event.id, mark);
}

}  // namespace self_awareness::core::paper
