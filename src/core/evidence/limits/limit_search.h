#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/evidence/count/robots.h"
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
  /// The longest gaps of an event type by part, as long as windows can tell them [ns].
  struct Gaps {
    std::size_t track = 0;
    std::vector<double> longest;
    std::vector<double> agreed;  // the same, without a hole where most starts agree on that
    double largest = 0;          // of those
    // How long recordings were silent in which an event type that is often silent had not come
    // yet, or came no more, or not at all.
    double cut_off = 0;
    // What one start shows much longer than all others do: it may have been a fault.
    std::optional<std::size_t> hole_in;  // this start
    double without_hole = 0;             // the longest of the others
  };

  /// A part of a recording that was not trained on.
  struct GapPart {
    const LimitFinder::Recording::Part* said = nullptr;
    const LimitFinder::Recording* of = nullptr;
  };

  void gatherParts(const LimitFinder::Findings& findings);
  Gaps gapsOf(std::size_t track) const;
  /// A gap, as long as windows can tell it [ns]; 0: there is none.
  double asTold(std::int64_t gap) const;
  /// Whether a recording that was not trained on lacks an event type that is often silent.
  bool lacks(const LimitFinder::Recording& recording, EventId id, bool often_silent) const;
  void findHole(Gaps& gaps) const;
  /// Leaves holes out where five starts heard the type. What several components have in one start
  /// is none: that is what the robot does.
  void leaveHolesOut(std::vector<Gaps>& all) const;
  /// Share of the messages of all timers that are not fast, of which one at a time was lost, as
  /// far as recordings show. Where none was, but may have been: that of all messages, as their
  /// numbers tell.
  double lossesOf(const std::vector<Gaps>& all) const;
  /// Messages of a timer that came, by the recordings.
  double numberOf(EventId id) const;
  /// Finds the limit of a silence.
  /// @param rate of longer ones an hour that is rare
  void limitSilence(const Gaps& gaps, double rate, LeftOut& left_out);
  /// Finds the limit of other evidence.
  void limitEvidence(std::size_t track, LeftOut& left_out);
  /// Sets a limit. @return whether other robots tell about the track
  /// @param largest value that was seen
  /// @param most that is normal
  bool limit(std::size_t track, double largest, double most);
  /// The longest silence of each start with one, cut off or not, the longest first [ns].
  std::vector<double> longestOfStarts(const Gaps& gaps) const;
  /// How much the starts of the robot differ in how long it pauses: by how many nats the longest
  /// pauses of half of them exceed that of the next start, in the mean of all that pauses.
  double spreadOf(const std::vector<Gaps>& all) const;
  /// Whether only one of several robots has what a track watches: no other one tells about it.
  bool isOfOneRobot(std::size_t track) const;
  /// Age [ns] that silences of a track reach at a rate [1/h], by its longest gaps.
  double rareAge(const Gaps& gaps, double rate) const;
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
  double lost_ = 0;    // share of the messages of timers
  double spread_ = 0;  // of the starts' longest pauses [nat]
  std::vector<double> limits_;
  double rate_ = 0;
};

}  // namespace self_awareness::core::evidence
