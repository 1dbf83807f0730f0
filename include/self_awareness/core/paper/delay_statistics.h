#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "self_awareness/core/paper/delay_bins.h"
#include "self_awareness/core/paper/histogram.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"

namespace self_awareness::core::paper {

/// The delays between every ordered pair of event types, as counts (section III-B of the paper).
/// Counts of two trainings add up to the counts of a training on both.
class DelayStatistics {
 public:
  explicit DelayStatistics(const Binning& binning);

  /// Makes room for the event type and returns its id.
  EventId intern(const EventType& type);

  void countEvent(EventId id, std::uint64_t count = 1) { event_counts_.at(id) += count; }
  /// Histogram of the delay from the last e_i (`from`) to the current e_j (`to`).
  Histogram& pair(EventId from, EventId to) { return pairsTo(to).at(from); }
  const Histogram& pair(EventId from, EventId to) const;
  /// The histograms of all pairs with this e_j, by the id of e_i.
  std::vector<Histogram>& pairsTo(EventId to);

  /// Adds the counts of `other`; event types that are new here get ids behind the present ones.
  /// @throw std::invalid_argument if the two were binned differently.
  void merge(const DelayStatistics& other);

  const Binning& binning() const { return binning_; }
  const Vocabulary& vocabulary() const { return vocabulary_; }
  std::uint64_t eventCount(EventId id) const { return event_counts_.at(id); }
  /// Number of events counted, of all types.
  std::uint64_t events() const;
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

/// Counts the delays of one recording after the other into a DelayStatistics, all pairs in one
/// pass: listing 1 of the paper with the mends of METHOD.md. Nothing is counted for (i, j) before
/// e_i was seen in the recording, an event is counted before it is tracked, and no delay crosses
/// from one recording into the next. A step of the clock ends a recording, too (clock.h).
class DelayTrainer {
 public:
  /// @param statistics counted into; must outlive the trainer.
  explicit DelayTrainer(DelayStatistics& statistics);

  /// Forgets what was seen: the next event belongs to another recording.
  void startRecording();
  /// @param event with an id of the statistics' vocabulary; in the order of the recording.
  void add(const Event& event);

 private:
  DelayStatistics& statistics_;
  DelayBins bins_;
  SeenTypes seen_;
  std::optional<std::int64_t> last_stamp_;  // [ns]
};

}  // namespace self_awareness::core::paper
