#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/statistics.h"
#include "self_awareness/core/evidence/tuning.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

/// What a piece of evidence looks at (docs/method.md, section 3).
enum class Channel {
  kOverdue,    ///< `to` should have come by now
  kFewer,      ///< fewer `to` in the last kRateSpan than usual
  kMore,       ///< more of them than usual
  kDelay,      ///< `to` at unusual delays after `from`, at present
  kSlowDelay,  ///< the same, with less drift; for the linker only
  kAnswer,     ///< `from` without the `to` that usually comes before the next `from`
  kDeadline    ///< the `to` that `from` asks for does not come in time
};

/// The channel's name as people read it: overdue, rate, pairs, answers or deadlines.
std::string channelName(Channel channel);
/// Names of what can be switched off (Tuning::without).
std::vector<std::string> channelNames();

/// One thing that is watched all the time. What is watched follows from the counts of training.
struct Track {
  Channel channel = Channel::kOverdue;
  EventId to = 0;
  EventId from = 0;  ///< same as `to` if the channel looks at one event type only
};

/// A relation between two event types, and what speaks for it (docs/method.md, section 3.6).
struct Relation {
  bool watched = false;    ///< what speaks for it is enough
  bool reaches = false;    ///< messages of the one reach the node of the other
  bool irregular = false;  ///< the one says more about the other than its own history does
  double spread = 1;       ///< share of a period that the delays of all starts lie in, 0 to 1
  std::size_t starts = 0;  ///< that show it
  std::size_t starts_needed = 0;  ///< with which it would be watched; 0: it is, or no number helps
};

/// log P by bin [nat].
using LogProbabilities = std::array<double, kDelayBins>;
/// Logarithms of the probabilities of delays, with one more count in every bin (Laplace).
LogProbabilities logProbabilities(const Statistics::Delays& counts);
/// The same for sums of counts.
LogProbabilities logProbabilities(const Statistics::SumOfDelays& counts);

/// What the delay since the last e_i says about e_j beyond what it says about any event: gain(i,
/// j) of docs/method.md, section 3.4, one way. It is the mean of log P_ij - log Q_i [nat], learned
/// from one half of the training and measured on the other; Q_i is the delay since e_i at any
/// event. What holds within a recording only, such as the phase between two independent timers, is
/// no information.
class InformationGain {
 public:
  /// @param fewest_delays with fewer to measure on, a gain is 0 (Tuning)
  InformationGain(const Statistics& learned_from, const Statistics& measured_on,
                  double fewest_delays);

  /// Gain [nat]; 0 if there are too few delays to learn from or to measure on. Ids are those of
  /// `learned_from`.
  double operator()(EventId from, EventId to) const;

 private:
  const Statistics& learned_from_;
  const Statistics& measured_on_;
  double fewest_delays_;
  std::vector<std::optional<EventId>> id_there_;  // in measured_on_, by id
  std::vector<LogProbabilities> any_;             // of the delays since e_i at any event, by i
};

/// What the evidence detector keeps of a training: what is watched, and the counts that this
/// needs.
struct Watched {
  std::vector<Track> tracks;
  std::array<Statistics, 2> halves;  ///< of the training, with the same event types
  Tuning tuning;                     ///< by which they were chosen
};

/// Chooses what to watch by the counts of the two halves of the training (docs/method.md, sections
/// 3.2 to 3.6). Each half gets the event types that it lacks from the other.
/// @param graph who hears whom; empty: not known
Watched watch(const Statistics& first, const Statistics& second, const SourceGraph& graph = {},
              const Tuning& tuning = {});

/// Checks tracks that come from outside.
/// @param types number of event types
/// @throw std::invalid_argument if a track is of none of them, or the two delay tracks of a pair
/// are not neighbours, the slow one after the other
void checkTracks(const std::vector<Track>& tracks, std::size_t types);

/// Share of the gaps of an event type in which another did not answer, above 0 and below 1: p of
/// docs/method.md, section 3.5, before it is clipped.
double missRate(std::uint64_t gaps, std::uint64_t answers);

}  // namespace self_awareness::core::evidence
