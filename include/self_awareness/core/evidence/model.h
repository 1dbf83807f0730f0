#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/statistics.h"
#include "self_awareness/core/evidence/tracks.h"
#include "self_awareness/core/evidence/tuning.h"

namespace self_awareness::core::evidence {

/// The largest evidence that is normal (docs/method.md, section 5): LimitFinder
/// (evidence/limits.h) finds it on recordings of normal operation.
struct Limits {
  /// By track of the model, in units of its evidence; NaN: not judged, the track proved useless or
  /// misleading.
  std::vector<double> tracks;
  double linker = std::numeric_limits<double>::quiet_NaN();
  /// From the start of a recording to the first event of a type, the latest of all recordings
  /// [ns], by id; -1: it did not come in one. Empty: what training says is all that is known.
  std::vector<std::int64_t> firsts{};
};

/// What normal operation lets expect of every track (docs/method.md, sections 3.1 to 3.5). It is
/// computed once from counts and never changes, so threads may share it.
class Model {
 public:
  /// The counts that probabilities are learned from. A model of one half is tried on the other: it
  /// shows what a model of both will do on new data.
  enum class Learned { kBoth, kFirst, kSecond };

  /// @throw std::invalid_argument if there is no event type, the tracks do not fit the event
  /// types, or a number of the tuning is out of its range
  explicit Model(const Watched& watched, Learned learned = Learned::kBoth);

  /// The numbers of the method that it was made with.
  const Tuning& tuning() const { return tuning_; }
  const Vocabulary& vocabulary() const { return statistics_.vocabulary(); }
  std::size_t size() const { return statistics_.size(); }
  /// Whether training saw the event type; the ids after those of training stand for unknown
  /// events.
  bool knows(EventId id) const { return id < size(); }
  /// Counts of both halves, of the pairs that are watched.
  const Statistics& statistics() const { return statistics_; }
  /// What is watched; the same for all values of Learned. The two delay tracks of a pair are
  /// neighbours, the slow one after the other.
  const std::vector<Track>& tracks() const { return tracks_; }
  /// Names of the components: sources, or topics where the sources are not known.
  const std::vector<std::string>& components() const { return components_; }
  /// The component that an event type comes from.
  const std::string& component(EventId id) const { return components_[component_of_.at(id)]; }
  /// Its index in components().
  std::size_t componentIndex(EventId id) const { return component_of_.at(id); }

  /// Evidence of channel overdue [nat]: -log of the probability, at a random moment of normal
  /// operation, of an age of at least `age` [ns] (docs/method.md, section 3.2).
  double overdue(EventId id, std::int64_t age) const;
  /// Natural logarithm of the probability of a gap of at least this age [ns] between two events of
  /// the type (docs/method.md, section 6): the share of such gaps in training, with an exponential
  /// tail after the longest one. 0 if the type is too rare to be judged.
  double logSurvival(EventId id, std::int64_t age) const;
  /// Longest gap between two events of the type in training [ns]; 0 if there was none.
  std::int64_t longestGap(EventId id) const;
  /// Longest time without any event in training [ns].
  std::int64_t longestSilence() const;
  /// Whether a deadline track counts requests without an answer, not seconds: requests come in
  /// series (docs/method.md, section 3.5).
  bool countsRequests(std::size_t track) const;
  /// Mean gap between two events of the type in training [ns]; 0 if there was none.
  double meanGap(EventId id) const;
  /// Delay from `from` to `to` [s] that a share (0 to 1) of the delays in training did not exceed.
  /// Exact for the longest gaps of a type; an estimate within the bin for the others.
  double usualDelay(EventId from, EventId to, double share) const;
  /// Number of events of a type in kRateSpan that lies this many spreads above the mean.
  double usualCount(EventId id, double spreads) const {
    return rates_.at(id).mean + spreads * rates_[id].spread;
  }
  /// How many spreads a count of events in kRateSpan lies above the mean: z of docs/method.md,
  /// section 3.3.
  double rate(EventId id, std::uint32_t count) const;
  /// How surprising a delay is, by its bin, in standard deviations from the mean: z of
  /// docs/method.md, section 3.4.
  using Surprises = std::array<double, kDelayBins>;
  /// Surprises of a delay track; the same object for the two tracks of a pair. A bin that is
  /// harmless as a whole has none; of the others, harmless() tells which delays are.
  const Surprises& surprises(std::size_t track) const { return surprises_[surprises_of_[track]]; }
  /// Delays that differ too little from the usual ones to be a fault (docs/method.md,
  /// section 3.4).
  struct Harmless {
    double shortest = 0;  ///< [ns]
    double longest = 0;   ///< [ns]
    /// Delays near 0 wrap to it, and the other way round [ns]; 0: they do not.
    double period = 0;

    bool contains(double delay) const {
      const auto lies = [&](double shifted) { return shortest <= shifted && shifted <= longest; };
      return lies(delay) || (period > 0 && (lies(delay - period) || lies(delay + period)));
    }
  };
  /// Of a delay track; the same object for the two tracks of a pair.
  const Harmless& harmless(std::size_t track) const { return harmless_[surprises_of_[track]]; }
  /// Surprise of a delay [ns] of a delay track, 0 if it is harmless.
  double surprise(std::size_t track, std::int64_t delay) const;
  /// Smaller surprises add to no sum, so that it does not matter whether the delay is harmless.
  static constexpr double kSurprising = 0.5;
  /// What an answer that came adds to the evidence of an answer track [nat] (docs/method.md,
  /// section 3.5): log((1 - q) / (1 - p)).
  double answered(std::size_t track) const { return steps_[track].answered; }
  /// What an answer that did not come adds to it [nat]: log(q / p).
  double missed(std::size_t track) const { return steps_[track].missed; }
  /// Share of the gaps of `from` in which usually no `to` comes, of an answer track: p, 0 to 1.
  double missRate(std::size_t track) const { return steps_[track].usual; }
  /// Time [ns] in which the answer of an answer track usually comes: what asks again sooner asks
  /// nothing new (docs/method.md, section 3.5).
  std::int64_t usualAnswer(std::size_t track) const { return steps_[track].delay; }
  /// Least limit that a track may have, in units of its evidence (docs/method.md, section 5.3).
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
    double usual = 0;        // share that is missed
    std::int64_t delay = 0;  // that answers usually take [ns]
  };

  void numberComponents();
  void learnGaps();
  void learnRates();
  void learnDelays(const std::array<Statistics, 2>& halves);
  Harmless learnHarmless(EventId from, EventId to) const;
  void learnAnswers();

  /// What the probabilities are learned from.
  const Statistics& learned() const { return half_ ? *half_ : statistics_; }

  Statistics statistics_;           // of both halves
  std::optional<Statistics> half_;  // the one that is learned from, with the same ids
  std::vector<Track> tracks_;
  Tuning tuning_;
  std::vector<std::string> components_;
  std::vector<std::size_t> component_of_;  // by id
  std::vector<Gaps> gaps_;                 // by id
  std::vector<Rate> rates_;                // by id
  std::vector<Surprises> surprises_;       // of pairs
  std::vector<Harmless> harmless_;         // of pairs
  std::vector<std::size_t> surprises_of_;  // index of its surprises, by delay track
  std::vector<Steps> steps_;               // by answer track
};

}  // namespace self_awareness::core::evidence
