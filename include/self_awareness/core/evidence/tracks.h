#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/statistics.h"

namespace self_awareness::core::evidence {

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

/// log P by bin.
using LogProbabilities = std::array<double, kDelayBins>;
/// log P of a delay's bin, with one more count in every bin (Laplace).
LogProbabilities logProbabilities(const Statistics::Delays& counts);
LogProbabilities logProbabilities(const Statistics::SumOfDelays& counts);

/// How much the delay since the last e_i says of e_j beyond what it says of any event: the mean of
/// log P_ij - log Q_i [nat], Q_i: the delay since e_i at any event, learned from one half of the
/// training and measured on the other (docs/method.md, section 3.4). What holds within a recording
/// only, such as the phase between two independent timers, is no information.
class InformationGain {
 public:
  /// Fewer delays than this are not measured on.
  static constexpr std::uint64_t kFewestDelays = 50;

  InformationGain(const Statistics& learned_from, const Statistics& measured_on);

  /// 0 where there are no delays to learn from or to measure on. Ids are those of `learned_from`.
  double operator()(EventId from, EventId to) const;

 private:
  const Statistics& learned_from_;
  const Statistics& measured_on_;
  std::vector<std::optional<EventId>> id_there_;  // in measured_on_, by id
  std::vector<LogProbabilities> any_;             // of the delays since e_i at any event, by i
};

/// How many predecessors of an event type are watched, if nothing else is asked for. By
/// measurement (docs/performance.md): fewer find late answers later, many cost false alarms.
constexpr std::size_t kPredecessors = 3;

/// What the evidence keeps of a training: what is watched, and the counts that this needs.
struct Watched {
  std::vector<Track> tracks;
  std::array<Statistics, 2> halves;  ///< of the training, with the same event types
};

/// Chooses what to watch by the counts of the two halves of the training; of each half, event
/// types that the other lacks are added.
/// @param predecessors of an event type that are watched, the most informative ones
Watched watch(const Statistics& first, const Statistics& second,
              std::size_t predecessors = kPredecessors);

/// @param types number of event types
/// @throw std::invalid_argument if a track is of none of them, or the two tracks of a pair's
/// delays are not neighbours, the slow one behind the other
void checkTracks(const std::vector<Track>& tracks, std::size_t types);

/// Share of the gaps of an event type in which another did not answer, never quite 0 or 1.
double missRate(std::uint64_t gaps, std::uint64_t answers);

}  // namespace self_awareness::core::evidence
