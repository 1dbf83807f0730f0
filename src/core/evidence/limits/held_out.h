#pragma once

#include <cstddef>
#include <vector>

#include "self_awareness/core/evidence/tuning.h"

namespace self_awareness::core::evidence {

/// A part of a recording.
struct Part {
  std::size_t sample = 0;  ///< number of the start, or of the robot, that it is of (samplesOf())
  double hours = 0;
};

/// By how much a limit must lie above the largest value that was ever seen, so that a new
/// recording exceeds it as seldom as is asked for (docs/method.md, section 5.2). It learns this by
/// leaving out samples (robots, or starts of one), and parts, in turn: the values that one shows
/// beyond the others are a sample of what comes next. Tracks of one kind share what they show.
class HeldOut {
 public:
  /// @param parts all that was looked at; none may be empty
  /// @param scale by how much values exceed others on average (a logarithm), as is believed before
  /// anything is seen
  /// @param tuning must outlive this
  HeldOut(const std::vector<Part>& parts, double scale, const Tuning& tuning);

  /// Takes in a track.
  /// @param largest value in every part, 0 or more
  /// @param least limit of the track: smaller values do not matter
  void add(const std::vector<double>& largest, double least);

  /// Margin, 1 or more: a limit is so many times the largest value that was seen.
  /// @param rate exceedances an hour that are allowed to all tracks together
  double margin(double rate) const;
  /// By how much the largest value of a track exceeded those of all other samples; 1 if it did
  /// not, or if there is nothing to compare it with.
  double excess(const std::vector<double>& largest, double least) const;

 private:
  /// One way to leave out: groups of parts in turn.
  struct Level {
    std::vector<std::size_t> group_of;  // by part
    std::vector<double> hours;          // by group
    double eligible_hours = 0;          // of groups that the others can judge
    double exceedances = 0;
    double logarithms = 0;  // their sum, of by how much
  };

  static Level levelOf(const std::vector<Part>& parts, std::vector<std::size_t> group_of);
  /// log of by how much the largest group exceeds the others; 0 if it does not.
  double exceedance(const Level& level, const std::vector<double>& largest, double least) const;
  double scale(const Level& level) const;

  double prior_scale_;
  const Tuning& tuning_;
  std::vector<Level> levels_;  // by sample first
};

}  // namespace self_awareness::core::evidence
