#pragma once

#include <cstdint>
#include <vector>

#include "self_awareness/core/paper/binning.h"
#include "self_awareness/core/paper/histogram.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"

namespace self_awareness::core::paper {

/// Counts the delays between every ordered pair of event types (paper, section III-B;
/// docs/method.md, section 2.1). The counts of two trainings add up to those of a training on
/// both.
class DelayStatistics {
 public:
  explicit DelayStatistics(const Binning& binning);

  /// Makes room for the event type and returns its id.
  EventId intern(const EventType& type);

  void countEvent(EventId id, std::uint64_t count = 1) { event_counts_.at(id) += count; }
  /// Histogram of the delays from the last e_i (`from`) to the current e_j (`to`).
  Histogram& pair(EventId from, EventId to) { return pairsTo(to).at(from); }
  const Histogram& pair(EventId from, EventId to) const;
  /// The histograms of all pairs with this e_j, by the id of e_i.
  std::vector<Histogram>& pairsTo(EventId to);

  /// Adds the counts of `other`; event types that are new here get the next ids.
  /// @throw std::invalid_argument if the two were binned differently.
  void merge(const DelayStatistics& other);

  const Binning& binning() const { return binning_; }
  const Vocabulary& vocabulary() const { return vocabulary_; }
  /// Gives the event types other names.
  /// @param vocabulary of the same ids
  void rename(const Vocabulary& vocabulary) { vocabulary_ = vocabulary; }
  std::uint64_t eventCount(EventId id) const { return event_counts_.at(id); }
  /// Number of events counted, of all types.
  std::uint64_t events() const;
  /// Whether delays were counted, or only events.
  bool hasDelays() const;
  /// Number of ordered pairs with at least one delay.
  std::size_t pairs() const;

 private:
  Binning binning_;
  Vocabulary vocabulary_;
  std::vector<std::uint64_t> event_counts_;
  // [to][from]: contiguous for the current event, and as long as was needed
  std::vector<std::vector<Histogram>> pairs_;
};

bool operator==(const DelayStatistics& a, const DelayStatistics& b);

}  // namespace self_awareness::core::paper
