#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence/statistics.h"
#include "self_awareness/core/evidence/tracks.h"

namespace self_awareness::core::evidence {

/// When evidence is abnormal: found on normal data that was not trained on (evidence_limits.h).
struct Limits {
  /// By track of the model; NaN: not judged, the track proved useless or misleading.
  std::vector<double> tracks;
  double linker = std::numeric_limits<double>::quiet_NaN();
};

/// What normal operation lets expect, computed once from counts and never changed, so that threads
/// may share it.
class Model {
 public:
  /// The counts that probabilities are learned from. One half serves to try on the other what both
  /// together will do on data never seen.
  enum class Learned { kBoth, kFirst, kSecond };

  /// @throw std::invalid_argument if there is no event type, or the tracks are none of these
  explicit Model(const Watched& watched, Learned learned = Learned::kBoth);

  const Vocabulary& vocabulary() const { return statistics_.vocabulary(); }
  std::size_t size() const { return statistics_.size(); }
  /// Whether the id is one of training; ids behind it stand for events never seen there.
  bool knows(EventId id) const { return id < size(); }
  /// Counts of both halves, of the pairs that are watched.
  const Statistics& statistics() const { return statistics_; }
  /// What is watched, the same whatever the probabilities were learned from. The two tracks of a
  /// pair's delays are neighbours, the slow one behind the other.
  const std::vector<Track>& tracks() const { return tracks_; }

  /// Evidence of channel overdue [nat]: -log of the probability, at a random moment of normal
  /// operation, of an age of at least `age` [ns] (docs/method.md, section 3.2).
  double overdue(EventId id, std::int64_t age) const;
  /// Natural logarithm of the probability of a gap of at least this age [ns] between two events of
  /// the type: the share of such gaps in training, beyond the longest one b with the tail
  /// exp(-age / b). 0 if the type is too rare to be judged.
  double logSurvival(EventId id, std::int64_t age) const;
  /// Longest gap between two events of the type in training [ns]; 0 if there was none.
  std::int64_t longestGap(EventId id) const;
  /// Delay from `from` to `to` [s] that a share (0 to 1) of the delays in training did not exceed,
  /// as exactly as the bins are.
  double usualDelay(EventId from, EventId to, double share) const;
  /// Events of a type in kRateSpan, a number of spreads above the mean.
  double usualCount(EventId id, double spreads) const {
    return rates_.at(id).mean + spreads * rates_[id].spread;
  }
  /// How many spreads more events than on the average came in kRateSpan.
  double rate(EventId id, std::uint32_t count) const;
  /// How surprising the delays of each bin are, in standard deviations from what is usual.
  using Surprises = std::array<double, kDelayBins>;
  /// Those of a delay track; the same object for the two tracks of a pair.
  const Surprises& surprises(std::size_t track) const { return surprises_[surprises_of_[track]]; }
  /// What an answer that came, and one that did not, add to the evidence of an answer track: the
  /// log-likelihood ratio of half of those that usually come being left out [nat].
  double answered(std::size_t track) const { return steps_[track].answered; }
  double missed(std::size_t track) const { return steps_[track].missed; }
  /// Share of the gaps of `from` that a `to` is usually missing in, of an answer track.
  double missRate(std::size_t track) const { return steps_[track].usual; }
  /// The least that the limit of a track can be.
  double leastLimit(std::size_t track) const;

 private:
  struct Gaps {
    /// The gaps of a bin and of all longer ones.
    struct Bin {
      double middle = 0;  // [ns]
      double count = 0;
      double sum = 0;  // [ns]
    };
    std::vector<Bin> bins;  // the shortest gaps first
    double longest = 0;     // [ns]
  };
  struct Rate {
    double mean = 0;
    double spread = 1;
  };
  struct Steps {
    double answered = 0;
    double missed = 0;
    double usual = 0;  // share that is missed
  };

  void learnGaps();
  void learnRates();
  void learnDelays(const std::array<Statistics, 2>& halves);
  void learnAnswers();

  /// What the probabilities are learned from.
  const Statistics& learned() const { return half_ ? *half_ : statistics_; }

  Statistics statistics_;           // of both halves
  std::optional<Statistics> half_;  // that is learned from, with the same ids
  std::vector<Track> tracks_;
  std::vector<Gaps> gaps_;                 // by id
  std::vector<Rate> rates_;                // by id
  std::vector<Surprises> surprises_;       // of pairs
  std::vector<std::size_t> surprises_of_;  // index of its surprises, by track, of delay tracks
  std::vector<Steps> steps_;               // by track, of answer tracks
};

}  // namespace self_awareness::core::evidence
