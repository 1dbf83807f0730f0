#pragma once

#include <array>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence/count/delay_histogram.h"
#include "self_awareness/core/evidence/count/statistics.h"

namespace self_awareness::core::evidence {

/// What the delay since the last e_i says about e_j beyond what it says about any event: gain(i,
/// j) of docs/method.md, section 3.5, one way. It is the mean of log P_ij - log Q_i [nat], learned
/// from one half of the training and measured on the other; Q_i is the delay since e_i at any
/// event. What holds within a recording only, such as the phase between two independent timers, is
/// no information.
class InformationGain {
 public:
  /// Both statistics must outlive this.
  /// @param fewest_delays with fewer to measure on, a gain is 0
  InformationGain(const Statistics& learned_from, const Statistics& measured_on,
                  double fewest_delays);

  /// Gain [nat]; 0 if there are too few delays to learn from or to measure on. Ids are those of
  /// `learned_from`.
  double operator()(EventId from, EventId to) const;
  /// Gain [nat] that no learning exceeds: of what fits the delays that it is measured on best. 0
  /// without any.
  double most(EventId from, EventId to) const;

 private:
  const Statistics& learned_from_;
  const Statistics& measured_on_;
  double fewest_delays_;
  std::vector<std::optional<EventId>> id_there_;  // in measured_on_, by id
  std::vector<ByBin> any_;                        // of the delays since e_i at any event, by i
};

/// Gains of all pairs: the mean of learning from either half (docs/method.md, section 3.5).
class Gains {
 public:
  /// @param halves of the training, with the same event types
  Gains(const std::array<const Statistics*, 2>& halves, double fewest_delays);

  double operator()(EventId from, EventId to) const { return gains_[to * size_ + from]; }

 private:
  void add(const Statistics& learned_from, const Statistics& measured_on, double fewest_delays);

  std::size_t size_;
  std::vector<double> gains_;
};

}  // namespace self_awareness::core::evidence
