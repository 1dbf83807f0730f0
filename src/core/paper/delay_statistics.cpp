#include "self_awareness/core/paper/delay_statistics.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace self_awareness::core::paper {

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

bool DelayStatistics::hasDelays() const {
  return std::any_of(pairs_.begin(), pairs_.end(),
                     [](const std::vector<Histogram>& to) { return !to.empty(); });
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

}  // namespace self_awareness::core::paper
