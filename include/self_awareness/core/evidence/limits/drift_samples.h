#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence/limits/drift.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {

/// What is one sample of a Drift: all that was normal in a start of the robot, or in a day of one
/// (docs/learn.md). Hours of a start are no independent draws, and what a robot does depends
/// on the time of day; so neither hours nor files are samples. Times are in ns.
class DriftSamples {
 public:
  /// Of starts that are not known, one ends with a longer pause than this.
  static constexpr std::int64_t kLongestPause = 60 * kNanosecondsPerSecond;

  /// A time that was normal.
  struct Stretch {
    std::int64_t begin = 0;
    std::int64_t end = 0;
    std::int64_t robot_start = 0;  ///< the same for all of one start of the robot; 0: not known
    std::vector<double> shares;    ///< the largest of a limit, by component; 1 is the limit
  };

  /// @param components number of them
  explicit DriftSamples(std::size_t components) : complete_(components) {}

  /// Takes in the next stretch.
  /// @throw std::invalid_argument if the shares are of another number of components, or one is not
  /// finite or below 0
  void add(const Stretch& stretch);

  /// What they say, with the last one so far.
  Drift drift() const;

 private:
  /// The last sample: what comes next may belong to it.
  struct Newest {
    std::int64_t start = 0;        // begin of the first stretch of its start
    std::int64_t day = 0;          // of this start, from 0
    std::int64_t robot_start = 0;  // as in Stretch
    std::int64_t end = 0;          // of its last stretch
    std::vector<double> shares;
  };

  Drift complete_;  // what all but the last one say
  std::optional<Newest> newest_;
};

}  // namespace self_awareness::core::evidence
