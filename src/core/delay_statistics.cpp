#include "self_awareness/core/delay_statistics.h"

#include <numeric>
#include <stdexcept>

#include "self_awareness/core/clock.h"

namespace self_awareness::core {

DelayStatistics::DelayStatistics(const Binning& binning) : binning_(binning) {
  binning_.validate();
}

EventId DelayStatistics::intern(const EventType& type) {
  const EventId id = vocabulary_.intern(type);
  if (id == event_counts_.size()) {
    event_counts_.push_back(0);
    for (std::vector<Histogram>& predecessors : pairs_) {
      predecessors.emplace_back();
    }
    pairs_.emplace_back(vocabulary_.size());
  }
  return id;
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
      pair(here[from], here[to]).merge(other.pair(from, to));
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

void DelayTrainer::startRecording() {
  last_seen_.clear();
  last_stamp_.reset();
}

void DelayTrainer::add(const Event& event) {
  if (last_stamp_ && isClockStep(*last_stamp_, event.stamp)) {
    startRecording();
  }
  last_stamp_ = event.stamp;
  last_seen_.resize(statistics_.vocabulary().size());
  statistics_.countEvent(event.id);
  for (EventId from = 0; from < last_seen_.size(); ++from) {
    if (last_seen_[from]) {
      const std::int64_t delay = event.stamp - *last_seen_[from];
      statistics_.pair(from, event.id).add(statistics_.binning().bin(delay));
    }
  }
  last_seen_.at(event.id) = event.stamp;
}

}  // namespace self_awareness::core
