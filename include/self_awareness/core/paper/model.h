#pragma once

#include <cstdint>
#include <vector>

#include "self_awareness/core/paper/delay_statistics.h"

namespace self_awareness::core::paper {

class DelayTable;

/// The self-awareness model M = {P_ij} of section III-B with the entropies of eq. 4, computed once
/// from counts and never changed, so that threads may share it.
class Model {
 public:
  /// @throw std::invalid_argument if the statistics hold no event.
  explicit Model(const DelayStatistics& statistics);
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
  ~Model();

  const Vocabulary& vocabulary() const { return vocabulary_; }
  const Binning& binning() const { return binning_; }
  std::size_t size() const { return vocabulary_.size(); }
  /// Whether the id is one of training; ids behind it stand for events never seen there.
  bool knows(EventId id) const { return id < size(); }
  /// The histograms of an e_j with all e_i.
  const DelayTable& table(EventId to) const;

  /// P_ij of the bin of a delay [ns], 0 to 1; 0 for a pair without counts.
  double probability(EventId from, EventId to, std::int64_t delay) const;
  /// h_ij of eq. 4 [bit].
  double entropy(EventId from, EventId to) const;
  /// w_ij of eq. 4 where all event types of training are tracked; 1 if H_j is 0.
  double weight(EventId from, EventId to) const;
  /// The score that an event of training has on the average, all event types tracked.
  double expectedScore(EventId to) const;
  /// Delays between two events of the type.
  const Histogram& gaps(EventId id) const { return gaps_.at(id); }
  /// Natural logarithm of the probability of a gap of at least this age [ns] between two events
  /// of the type: the share of such gaps in training, beyond the longest one b with the tail
  /// exp(-age / b). 0 if the type has fewer than kFewestGaps.
  double logSurvival(EventId id, std::int64_t age) const;

 private:
  Vocabulary vocabulary_;
  Binning binning_;
  std::vector<DelayTable> tables_;    // by id of e_j
  std::vector<double> entropy_sums_;  // H_j over all e_i, by id of e_j
  std::vector<Histogram> gaps_;       // by id
};

}  // namespace self_awareness::core::paper
