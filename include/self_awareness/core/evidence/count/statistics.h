#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/count/attribute_counts.h"
#include "self_awareness/core/evidence/count/delay_histogram.h"
#include "self_awareness/core/evidence/count/pair_set.h"
#include "self_awareness/core/evidence/count/partners.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/stream/vocabulary.h"

namespace self_awareness::core::evidence {

/// The rate of an event type is its number of events in this time [ns] (docs/method.md, section
/// 1.4).
constexpr std::int64_t kRateSpan = 2 * kNanosecondsPerSecond;

/// Number of windows of the length `window` [ns] in kRateSpan, at least 1.
/// @throw std::invalid_argument if the length is out of range
std::size_t rateWindows(std::int64_t window);

/// The counts that the evidence detector learns (docs/method.md, section 3.1). The counts of two
/// trainings add up to those of a training on both.
class Statistics {
 public:
  /// So many of the longest gaps of a type are kept: limits are extrapolated from them.
  static constexpr std::size_t kLongestGaps = 32;

  /// Counts of one event type.
  struct Type {
    std::uint64_t events = 0;
    std::uint64_t gaps = 0;
    std::int64_t gap_sum = 0;                ///< [ns]
    std::vector<std::int64_t> longest_gaps;  ///< [ns], the longest first
    std::uint64_t rate_sum = 0;              ///< sum of the recent counts of all windows
    std::uint64_t rate_squares = 0;          ///< sum of their squares
    /// Delays since the last event of the type in pairs that only() or without() left out.
    SumOfDelays left_out{};
    AttributeCounts attributes;

    /// Keeps the gap [ns] if it is one of the longest.
    void addGap(std::int64_t gap);
    /// Mean gap [ns]; 0 if there was none.
    double meanGap() const {
      return gaps == 0 ? 0 : static_cast<double>(gap_sum) / static_cast<double>(gaps);
    }
    /// Longest gap [ns]; 0 if there was none.
    std::int64_t longestGap() const { return longest_gaps.empty() ? 0 : longest_gaps.front(); }
  };
  /// What one recording said of every event type. The independent sample of what is normal is a
  /// recording, not an event: what did not vary in one may differ in the next.
  struct Recording {
    std::int64_t start = 0;  ///< stamp of the first event [ns]
    std::int64_t end = 0;    ///< latest stamp [ns]
    /// Between two events in a row, of any types, that was no stall of the machine [ns].
    std::int64_t longest_silence = 0;
    std::int64_t longest_stall = 0;  ///< of the machine [ns]; 0: there was none
    /// By id; 0 for ids beyond. addRecording() leaves out what never came at the end.
    std::vector<std::uint64_t> events;
    /// Longest time between two events [ns] by id, as long as events; 0: there were no two.
    std::vector<std::int64_t> longest_gaps;
    /// From the start of the whole recording to the first event [ns] by id, as long as events; -1:
    /// it did not come.
    std::vector<std::int64_t> firsts;
    std::int64_t robot_start = 0;  ///< when the robot was started [ns]; 0: not known
    std::string robot{};           ///< its name; empty: not known
  };
  /// An ordered pair of event types, `from` before `to`.
  struct Pair {
    EventId from = 0;
    EventId to = 0;
  };

  /// Makes room for the event type and returns its id.
  EventId intern(const EventType& type);
  /// Adds the counts of `other`; event types that are new here get the next ids. What one of them
  /// has left out for good is left out.
  void merge(const Statistics& other);

  const Vocabulary& vocabulary() const { return vocabulary_; }
  /// Gives the event types other names.
  /// @param vocabulary of the same ids
  void rename(const Vocabulary& vocabulary) { vocabulary_ = vocabulary; }
  std::size_t size() const { return vocabulary_.size(); }
  Type& type(EventId id) { return types_.at(id); }
  const Type& type(EventId id) const { return types_.at(id); }
  /// Delays from the last `from` to a `to`; zeros where none was counted.
  DelayHistogram delays(EventId from, EventId to) const;
  /// Number of these delays.
  std::uint64_t total(EventId from, EventId to) const;
  /// Gaps of `from` in which a `to` came.
  std::uint64_t answers(EventId from, EventId to) const;
  const Partners& partners(EventId id) const { return partners_.at(id); }
  /// Replaces the partners of an event type.
  /// @throw std::invalid_argument if one of them is no event type
  void setPartners(EventId id, Partners partners);
  /// Counts events of a type: Partners::count(), by bins of all event types.
  void count(EventId id, const std::vector<std::uint8_t>& bins,
             const std::vector<std::uint8_t>& came);

  /// Delays from the last event of a type to any event, by type; ticks of a mode are none.
  std::vector<SumOfDelays> delaysToAny() const;
  /// The counts of all event types, but only of these pairs, in both orders. delaysToAny() stays
  /// the same.
  Statistics only(const std::vector<Pair>& pairs) const;
  /// The counts without these pairs, for good: merge() keeps them out. delaysToAny() stays the
  /// same.
  Statistics without(const PairSet& pairs) const;
  /// The counts of all event types without any pair.
  Statistics withoutPairs() const;

  /// The pairs that were left out for good.
  const PairSet& leftOut() const { return left_out_; }
  /// Says that a pair was left out for good.
  /// @throw std::invalid_argument if one of them is no event type, or the pair has counts
  void leaveOut(EventId from, EventId to);

  /// Windows in which rates were counted, the same for all types.
  std::uint64_t rateWindows() const { return rate_windows_; }
  void addRateWindows(std::uint64_t windows) { rate_windows_ += windows; }
  /// Variance of the number of events of a type in kRateSpan.
  double rateVariance(EventId id) const;
  /// How many events of a type say as much as one that is independent of others, 1 at least: they
  /// come in clumps (index of dispersion of their number in kRateSpan, Cox and Lewis 1966).
  double dispersion(EventId id) const;
  /// Recordings that were counted, in the order of their start.
  const std::vector<Recording>& recordings() const { return recordings_; }
  void addRecording(Recording recording);
  /// Time between the first and the last event of the recordings [ns].
  std::int64_t duration() const { return duration_; }
  void addDuration(std::int64_t duration) { duration_ += duration; }

 private:
  /// The counts with those pairs for which keep(to, from) holds.
  template <typename Keep>
  Statistics filtered(Keep keep) const;

  Vocabulary vocabulary_;
  std::vector<Type> types_;
  std::vector<Partners> partners_;  // by id: contiguous for the current event
  PairSet left_out_;                // for good
  std::vector<Recording> recordings_;
  std::uint64_t rate_windows_ = 0;
  std::int64_t duration_ = 0;
};

bool operator==(const Statistics& a, const Statistics& b);

}  // namespace self_awareness::core::evidence
