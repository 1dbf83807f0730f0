#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/evidence_statistics.h"

namespace self_awareness::core {

/// What a piece of evidence looks at.
enum class Channel {
  kOverdue,    ///< `to` should have come by now
  kFewer,      ///< fewer `to` in the last kRateSpan than usual
  kMore,       ///< more of them than usual
  kDelay,      ///< `to` at unusual delays after `from`, at present
  kSlowDelay,  ///< the same, sought for longer; for the linker only
  kAnswer      ///< `from` without the `to` that usually comes before the next `from`
};

/// The channel's name as people read it: overdue, rate, pairs or answers.
std::string channelName(Channel channel);

/// One thing that is watched all the time. What is watched follows from the counts of training.
struct Track {
  Channel channel = Channel::kOverdue;
  EventId to = 0;
  EventId from = 0;  ///< as `to` where the channel looks at one event type only
};

/// How much the delay since the last e_i says of e_j beyond what it says of any event: the mean of
/// log P_ij - log Q_i [nat], Q_i: the delay since e_i at any event, learned from one half of the
/// training and measured on the other (METHOD.md, section 3). What holds within a recording only,
/// such as the phase between two independent timers, is no information.
class InformationGain {
 public:
  /// Fewer delays than this are not measured on.
  static constexpr std::uint64_t kFewestDelays = 50;

  InformationGain(const EvidenceStatistics& learned_from, const EvidenceStatistics& measured_on);

  /// 0 where there are no delays to learn from or to measure on. Ids are those of `learned_from`.
  double operator()(EventId from, EventId to) const;

 private:
  const EvidenceStatistics& learned_from_;
  const EvidenceStatistics& measured_on_;
  std::vector<std::optional<EventId>> id_there_;  // in measured_on_, by id
  std::vector<std::vector<std::uint64_t>> any_;   // delays since e_i at any event, by i
};

/// log P of a delay's bin, with one more count in every bin (Laplace).
std::vector<double> logProbabilities(const std::vector<std::uint64_t>& counts);

/// What to watch, by the counts of the two halves of the training.
/// @param both the sum of the halves; its ids are those of the tracks
std::vector<Track> chooseTracks(const EvidenceStatistics& first, const EvidenceStatistics& second,
                                const EvidenceStatistics& both);

/// Share of the gaps of `from` in which no `to` came, never quite 0 or 1.
double missRate(const EvidenceStatistics& statistics, EventId from, EventId to);

}  // namespace self_awareness::core
