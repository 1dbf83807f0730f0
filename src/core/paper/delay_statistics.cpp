#include "self_awareness/core/paper/delay_statistics.h"

#include <array>
#include <numeric>
#include <stdexcept>

#include "self_awareness/core/stream/clock.h"

namespace self_awareness::core::paper {
namespace {

// Pairs that are worked on together.
constexpr std::size_t kBlock = 64;

}  // namespace

DelayStatistics::DelayStatistics(const Binning& binning) : binning_(binning) {
  binning_.validate();
}

EventId DelayStatistics::intern(const EventType& type) {
  const EventId id = vocabulary_.intern(type);
  if (id == event_counts_.size()) {
    event_counts_.push_back(0);
    pairs_.emplace_back();
  }
  return id;
}

const Histogram& DelayStatistics::pair(EventId from, EventId to) const {
  static const Histogram kEmpty;
  const std::vector<Histogram>& predecessors = pairs_.at(to);
  return from < predecessors.size() ? predecessors[from] : kEmpty;
}

std::vector<Histogram>& DelayStatistics::pairsTo(EventId to) {
  std::vector<Histogram>& predecessors = pairs_.at(to);
  if (predecessors.size() < vocabulary_.size()) {
    predecessors.resize(vocabulary_.size());
  }
  return predecessors;
}

void DelayStatistics::merge(const DelayStatistics& other) {
  if (!(binning_ == other.binning_)) {
    throw std::invalid_argument("statistics of different bin size or horizon cannot be added");
  }
  std::vector<EventId> here;
  here.reserve(other.vocabulary_.size());
  for (const EventType& type : other.vocabulary_.types()) {
    here.push_back(intern(type));
  }
  for (EventId to = 0; to < here.size(); ++to) {
    countEvent(here[to], other.event_counts_[to]);
    for (EventId from = 0; from < here.size(); ++from) {
      const Histogram& theirs = other.pair(from, to);
      if (!theirs.empty()) {
        pair(here[from], here[to]).merge(theirs);
      }
    }
  }
}

std::uint64_t DelayStatistics::events() const {
  return std::accumulate(event_counts_.begin(), event_counts_.end(), std::uint64_t{0});
}

std::size_t DelayStatistics::pairs() const {
  std::size_t filled = 0;
  for (const std::vector<Histogram>& predecessors : pairs_) {
    for (const Histogram& histogram : predecessors) {
      filled += histogram.empty() ? 0 : 1;
    }
  }
  return filled;
}

bool operator==(const DelayStatistics& a, const DelayStatistics& b) {
  if (!(a.binning() == b.binning()) || a.vocabulary().types() != b.vocabulary().types()) {
    return false;
  }
  for (EventId to = 0; to < a.vocabulary().size(); ++to) {
    if (a.eventCount(to) != b.eventCount(to)) {
      return false;
    }
    for (EventId from = 0; from < a.vocabulary().size(); ++from) {
      if (!(a.pair(from, to) == b.pair(from, to))) {
        return false;
      }
    }
  }
  return true;
}

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
  // All slots of a block are fetched before the first is needed: one after the other, they would
  // be waited for one after the other.
  std::array<EventId, kBlock> block;
  std::array<std::int64_t, kBlock> bins;
  EventId next = 0;
  while (next < seen_.size()) {
    std::size_t terms = 0;
    for (; next < seen_.size() && terms < kBlock; ++next) {
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
