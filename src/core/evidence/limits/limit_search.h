#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/evidence/count/robots.h"
#include "core/evidence/limits/gap_tail.h"
#include "core/evidence/limits/held_out.h"
#include "core/evidence/limits/left_out.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/limits/limits.h"

namespace self_awareness::core::evidence {

/// Finds the limits of a model's tracks from what recordings of normal operation showed
/// (docs/method.md, sections 5.2 and 5.3). LimitFinder gathers that.
class LimitSearch {
 public:
  /// @param model must outlive this, as the findings and the relations must
  /// @param relations by track; those that are not watched get no limit
  /// @param window length of one [ns]
  /// @param budget false alarms an hour that the limits allow, > 0
  LimitSearch(const Model& model, const LimitFinder::Findings& findings,
              const std::vector<Relation>& relations, std::int64_t window, double budget);

  /// Limits by track; NaN: not judged.
  const std::vector<double>& limits() const { return limits_; }
  /// False alarms an hour that no more are to be expected than, with a probability of 95 %.
  double rate() const { return rate_; }

 private:
  /// Tracks whose values exceed those of other recordings in the same way share what they show:
  /// silences of fast timers, of other timers, and of what comes irregularly; else those of
  /// channels with one label.
  enum class Kind { kFastTimers, kTimers, kOthers, kEvidence };
  using Pool = std::pair<Kind, std::string>;
  /// A track and its largest values.
  struct Seen {
    std::size_t track = 0;
    double least = 0;             // limit
    std::vector<double> largest;  // by part
    std::vector<double> agreed;   // the same, without what one start alone shows
  };

  /// A part of a recording that was not trained on.
  struct GapPart {
    const LimitFinder::Recording::Part* said = nullptr;
    const LimitFinder::Recording* of = nullptr;
  };

  void gatherParts(const LimitFinder::Findings& findings);
  /// What a track showed, and the pool that it belongs to.
  std::pair<Pool, Seen> seenBy(std::size_t track) const;
  /// Longest gaps by part [ns], as long as windows can tell them.
  std::vector<double> gapsOf(EventId id) const;
  /// A gap, as long as windows can tell it [ns]; 0: there is none.
  double asTold(std::int64_t gap) const;
  Kind kindOfGaps(const Seen& seen) const;
  /// Longest gaps by part, as far as most starts agree on them: where five heard it, what one
  /// shows much longer than all others do was a fault, and counts as these.
  std::vector<double> agreedOn(const std::vector<double>& longest) const;
  /// Share of the messages of all timers that are not fast, of which one at a time was lost, as
  /// far as recordings show.
  double lossesOf(const std::map<Pool, std::vector<Seen>>& pools) const;
  /// Messages of a timer that came, by the recordings.
  double numberOf(EventId id) const;
  /// Finds the limits of a pool.
  /// @param share of the budget
  /// @param left_out told of each track that is judged
  void search(Kind kind, const std::vector<Seen>& tracks, double share, LeftOut& left_out);
  /// Age [ns] up to which a silence is normal.
  /// @param largest that was seen [ns]
  /// @param age by that, and its margin [ns]
  /// @param rate of longer ones an hour, where pauses are long or irregular
  double longestAge(Kind kind, const Seen& seen, double largest, double age, double rate) const;
  /// Longest gap of a timer [ns] that is normal, where a message may be lost.
  /// @param largest that was seen, and a window [ns]
  /// @param rate of losses an hour that are rare
  double withALoss(std::size_t track, double largest, double rate) const;
  /// Number of samples with a gap of an event type whose silence is judged.
  std::size_t samplesThatHeard(const std::vector<double>& longest) const;
  /// Whether only one of several robots has what a track watches: no other one tells about it.
  bool isOfOneRobot(std::size_t track) const;
  /// Gaps of the training, and the longest ones of parts.
  /// @param longest that most starts agree on [ns]
  Statistics::Type gapsWithParts(EventId id, double longest) const;
  /// @param gaps of gapsWithParts()
  /// @param starts that heard it
  GapTail tailOf(Statistics::Type gaps, std::size_t track, double starts) const;
  double window() const { return static_cast<double>(window_); }

  const Model& model_;
  const Tuning& tuning_;
  std::int64_t window_;
  Robots robots_;  // of all recordings
  // Of the training, the gaps of each recording are known; the other evidence only where its
  // recordings were judged by each other.
  std::vector<Part> judged_;
  std::vector<const LimitFinder::Recording::Part*> judged_parts_;
  std::vector<Part> with_gaps_;  // the recordings of the training first
  std::vector<GapPart> gap_parts_;
  double longest_recording_ = 0;  // [ns]
  double lost_ = 0;               // share of the messages of timers
  std::vector<double> limits_;
  double rate_ = 0;
};

}  // namespace self_awareness::core::evidence
