#pragma once

#include <cstdint>
#include <vector>

#include "self_awareness/core/paper/delay_statistics.h"

namespace self_awareness::core::paper {

class DelayTable;

/// The self-awareness model M = {P_ij} with the entropies of eq. 4 (paper, section III-B;
/// docs/method.md, section 2.1). It is computed once from counts and never changes, so threads may
/// share it.
class Model {
 public:
  /// @throw std::invalid_argument if the statistics hold no event.
  explicit Model(const DelayStatistics& statistics);
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
  ~Model();

  /// The event types of the training, by id.
  const Vocabulary& vocabulary() const { return vocabulary_; }
  /// How the delays of the training were put into bins.
  const Binning& binning() const { return binning_; }
  /// Number of event types of the training.
  std::size_t size() const { return vocabulary_.size(); }
  /// Whether training saw the event type; the ids after those of training stand for unknown
  /// events.
  bool knows(EventId id) const { return id < size(); }
  /// The histograms of an e_j with all e_i.
  const DelayTable& table(EventId to) const;

  /// P_ij of the bin of a delay [ns], 0 to 1; 0 for a pair without counts.
  double probability(EventId from, EventId to, std::int64_t delay) const;
  /// h_ij of eq. 4 [bit].
  double entropy(EventId from, EventId to) const;
  /// w_ij of eq. 4 once all event types of training were seen; 1 if H_j is 0.
  double weight(EventId from, EventId to) const;
  /// Score to expect of an event by training, once all event types of training were seen
  /// (docs/method.md, section 2.5, group 3).
  double expectedScore(EventId to) const;
  /// Delays between two events of the type.
  const Histogram& gaps(EventId id) const { return gaps_.at(id); }
  /// Natural logarithm of the probability P(gap >= age) of docs/method.md, section 2.5: the share
  /// of the gaps in training that are at least as long as the age [ns], with an exponential tail
  /// after the longest one. 0 if the type has fewer gaps than kFewestGaps.
  double logSurvival(EventId id, std::int64_t age) const;

 private:
  Vocabulary vocabulary_;
  Binning binning_;
  std::vector<DelayTable> tables_;    // by id of e_j
  std::vector<double> entropy_sums_;  // H_j over all e_i, by id of e_j
  std::vector<Histogram> gaps_;       // by id
};

}  // namespace self_awareness::core::paper
