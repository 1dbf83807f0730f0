#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <string>

namespace self_awareness {

/// Simulated time that several publishers of /clock set in turn, each by its own. ROS time is
/// worth nothing then: it is set many times a second, and who waits until it has settled waits for
/// ever. While that goes on, time runs on from where it was by the steady clock, at the pace that
/// it had.
///
/// Belongs to one thread. Times are in nanoseconds.
class ClockContest {
 public:
  /// Over when ROS time was not set for so long [of steady time].
  static constexpr std::int64_t kOverAfter = 10000000000;

  /// @param publishers of /clock, as the master names them
  void setPublishers(std::set<std::string> publishers) { publishers_ = std::move(publishers); }

  /// A look at both clocks.
  /// @param simulated whether ROS time comes from /clock
  /// @return the time that counts
  std::int64_t look(std::int64_t ros_now, std::int64_t steady_now, bool simulated);
  /// The time that counts for what was received at this moment.
  std::int64_t timeOf(std::int64_t ros_time, std::int64_t steady_time) const;

  /// Whether ROS time is not what counts.
  bool contested() const { return since_.has_value(); }
  /// Who publishes /clock, if several do, in words; empty: one or nobody.
  std::string rivals() const;

 private:
  struct Look {
    std::int64_t ros_time;
    std::int64_t steady_time;
  };

  /// How fast ROS time ran lately, compared with the steady clock.
  double pace() const;

  std::set<std::string> publishers_;
  std::optional<Look> last_;
  std::deque<Look> recent_;    // about one in a second, since ROS time was set
  std::optional<Look> since_;  // from where time runs on; none: it is not contested
  double pace_ = 1;            // at which it does
  std::int64_t set_at_ = 0;    // steady time
};

}  // namespace self_awareness
