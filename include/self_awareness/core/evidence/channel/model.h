#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/channel/watched.h"
#include "self_awareness/core/evidence/count/gap_distribution.h"
#include "self_awareness/core/evidence/count/statistics.h"
#include "self_awareness/core/evidence/tuning.h"

namespace self_awareness::core::evidence {

class Expectation;

/// The largest evidence that is normal (docs/method.md, section 5): LimitFinder (limits/limits.h)
/// finds it on recordings of normal operation.
struct Limits {
  /// By track of the model, in units of its evidence; NaN: not judged, the track proved useless or
  /// misleading.
  std::vector<double> tracks;
  /// From the start of a recording to the first event of a type, the latest of all recordings
  /// [ns], by id; -1: it did not come in one. Empty: what training says is all that is known.
  std::vector<std::int64_t> firsts{};
};

/// What normal operation lets expect of every track (docs/method.md, section 3). It is computed
/// once from counts and never changes, so threads may share it.
class Model {
 public:
  /// The counts that probabilities are learned from. A model of one half is tried on the other: it
  /// shows what a model of both will do on new data.
  enum class Learned { kBoth, kFirst, kSecond };

  /// @throw std::invalid_argument if there is no event type, the tracks do not fit the event
  /// types, or a number of the tuning is out of its range
  explicit Model(const Watched& watched, Learned learned = Learned::kBoth);
  ~Model();
  // What the channels expect refers to it.
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  /// The numbers of the method that it was made with.
  const Tuning& tuning() const { return tuning_; }
  const Vocabulary& vocabulary() const { return statistics_.vocabulary(); }
  std::size_t size() const { return statistics_.size(); }
  /// Whether training saw the event type; the ids after those of training stand for unknown
  /// events.
  bool knows(EventId id) const { return id < size(); }
  /// Counts of both halves, of the pairs that are watched.
  const Statistics& statistics() const { return statistics_; }
  /// What the probabilities are learned from.
  const Statistics& learned() const { return half_ ? *half_ : statistics_; }
  /// What is watched; the same for all values of Learned.
  const std::vector<Track>& tracks() const { return tracks_; }
  /// Whom the evidence of a track speaks against.
  Finding finding(std::size_t track) const { return findings_[track]; }
  /// What the channels expect, those that watch anything.
  const std::vector<std::unique_ptr<const Expectation>>& expectations() const {
    return expectations_;
  }
  /// What the channel of a track expects.
  const Expectation& expectation(std::size_t track) const {
    return *expectations_[expectation_of_.at(track)];
  }
  /// Names of the components: sources, or topics where the sources are not known.
  const std::vector<std::string>& components() const { return components_; }
  /// The component that an event type comes from.
  const std::string& component(EventId id) const { return components_[component_of_.at(id)]; }
  /// Its index in components().
  std::size_t componentIndex(EventId id) const { return component_of_.at(id); }

  /// Natural logarithm of the probability of a gap of at least this age [ns] between two events of
  /// the type (docs/method.md, section 6). 0 if the type is too rare to be judged.
  double logSurvival(EventId id, std::int64_t age) const;
  /// Whether a silence [ns] is so long as gaps in training rarely were.
  bool isRare(EventId id, std::int64_t silence) const;
  /// Longest gap between two events of the type in training [ns]; 0 if there was none.
  std::int64_t longestGap(EventId id) const { return statistics_.type(id).longestGap(); }
  /// Whether it pauses, rather than comes in regular gaps.
  bool pauses(EventId id) const {
    return static_cast<double>(longestGap(id)) > tuning_.regular * meanGap(id);
  }
  /// What its sender may say in its place: the other values on the topic, if it pauses.
  const std::vector<EventId>& inPlaceOf(EventId id) const { return in_place_of_[id]; }
  /// The same as longestGap(), and as long as things that happen at one moment are apart,
  /// kRateSpan [ns].
  std::int64_t longestPause(EventId id) const { return longestGap(id) + kRateSpan; }
  /// Longest gap, or what recordings cut off of a type that is often silent [ns]:
  /// heads_and_tails.h
  std::int64_t longestSilence(EventId id) const;
  /// Longest time without any event in training that was no stall of the machine [ns].
  std::int64_t longestSilence() const;
  /// Longest stall of the machine in training [ns]; 0: there was none.
  std::int64_t longestStall() const;
  /// Mean gap between two events of the type in training [ns]; 0 if there was none.
  double meanGap(EventId id) const { return statistics_.type(id).meanGap(); }
  /// Delay from `from` to `to` [ns] that a share (0 to 1) of the delays in training did not
  /// exceed. Exact for the longest gaps of a type; an estimate within the bin for the others.
  double usualDelay(EventId from, EventId to, double share) const;
  /// Share of the messages that were lost in training, as the numbers in them say. Who lost more
  /// than Tuning::rare did so by itself, and says nothing of the others.
  double shareOfLosses() const;
  /// Least limit that a track may have, in units of its evidence (docs/method.md, section 5.3).
  double leastLimit(std::size_t track) const;

 private:
  void numberComponents();
  void findOtherValues();
  void letChannelsExpect(const Halves& halves);

  Statistics statistics_;           // of both halves
  std::optional<Statistics> half_;  // the one that is learned from, with the same ids
  std::vector<Track> tracks_;
  Tuning tuning_;
  std::vector<std::string> components_;
  std::vector<std::size_t> component_of_;          // by id
  std::vector<std::vector<EventId>> in_place_of_;  // by id
  std::vector<GapDistribution> gaps_;              // by id
  std::vector<std::unique_ptr<const Expectation>> expectations_;
  std::vector<std::size_t> expectation_of_;  // index of its channel's, by track
  std::vector<Finding> findings_;            // by track
};

}  // namespace self_awareness::core::evidence
