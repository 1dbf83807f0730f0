#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "self_awareness/core/evidence/limits/drift.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {

/// What is one sample of a Drift: all that was normal in a start of the robot, or in a day of one
/// (docs/learn_more.md). Hours of a start are no independent draws, and what a robot does depends
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
  /// Where the last sample lies: what comes next may belong to it.
  struct Place {
    std::int64_t start = 0;        ///< begin of the first stretch of its start
    std::int64_t day = 0;          ///< of this start, from 0
    std::int64_t robot_start = 0;  ///< as in Stretch
    std::int64_t end = 0;          ///< of the last stretch
  };

  /// @param components number of them
  /// @param most samples; then, further ones are left out
  explicit DriftSamples(std::size_t components,
                        std::size_t most = std::numeric_limits<std::size_t>::max());
  /// Goes on with samples of before.
  /// @param samples shares by component of each, in order
  /// @param last where the last one of them lies
  /// @throw std::invalid_argument as add()
  void restore(const std::vector<std::vector<double>>& samples, const Place& last);

  /// Takes in the next stretch.
  /// @return whether that says anything new: a share is larger than those before in the sample
  /// @throw std::invalid_argument if the shares are of another number of components, or one is not
  /// finite or below 0
  bool add(const Stretch& stretch);

  /// Shares by component of each, the last one so far.
  const std::vector<std::vector<double>>& list() const { return list_; }
  const Place& last() const { return last_; }
  bool isFull() const { return list_.size() >= most_; }
  /// What they say, with the last one so far. That can only grow with what comes yet of the last
  /// one: to ask in the middle of it tells no false alarm that its end does not.
  Drift drift() const;

 private:
  void begin(std::vector<double> shares);

  std::size_t components_;
  std::size_t most_;
  std::vector<std::vector<double>> list_;
  Place last_;
  Drift complete_;  // what all but the last one say
};

}  // namespace self_awareness::core::evidence
