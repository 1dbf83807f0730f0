#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "self_awareness/core/delay_statistics.h"

namespace self_awareness::core {

/// The self-awareness model M = {P_ij} of section III-B with the entropies of eq. 4, computed once
/// from counts and never changed, so that threads may share it.
class Model {
 public:
  /// @throw std::invalid_argument if the statistics hold no event.
  explicit Model(DelayStatistics statistics);

  const DelayStatistics& statistics() const { return statistics_; }
  const Vocabulary& vocabulary() const { return statistics_.vocabulary(); }
  const Binning& binning() const { return statistics_.binning(); }
  std::size_t size() const { return vocabulary().size(); }
  /// Whether the id is one of training; ids behind it stand for events never seen there.
  bool knows(EventId id) const { return id < size(); }

  /// P_ij of the bin of a delay [ns], 0 to 1; 0 for a pair without counts.
  double probability(EventId from, EventId to, std::int64_t delay) const;
  /// h_ij of eq. 4 [bit]; row: from (i), column: to (j).
  const Eigen::MatrixXd& entropies() const { return entropies_; }
  /// w_ij of eq. 4 where all event types of training are tracked; 1 if H_j is 0.
  double weight(EventId from, EventId to) const;

 private:
  DelayStatistics statistics_;
  Eigen::MatrixXd entropies_;
};

}  // namespace self_awareness::core
