#include "self_awareness/core/stream/clock_watch.h"

#include <algorithm>
#include <cstdlib>

#include "self_awareness/core/stream/clock.h"

namespace self_awareness::core {

// A replay may run faster than the robot did, but not a hundred times as fast.
constexpr std::int64_t kFastestSimulation = 100;
constexpr std::int64_t kSmallestSimulatedStep = 5 * kNanosecondsPerSecond;

bool wasSet(std::int64_t ros_advance, std::int64_t steady_advance, bool simulated) {
  if (!simulated) {
    return std::abs(ros_advance - steady_advance) > kSmallestStep;
  }
  return ros_advance < -kLatestEvent ||
         ros_advance > std::max(kSmallestSimulatedStep, kFastestSimulation * steady_advance);
}

bool ClockWatch::look(std::int64_t ros_now, std::int64_t steady_now, bool simulated) {
  const bool set =
      last_ && wasSet(ros_now - last_->ros_time, steady_now - last_->steady_time, simulated);
  if (!last_ || !simulated || ros_now != last_->ros_time) {
    advanced_at_ = steady_now;
  }
  pause_ = last_ ? steady_now - last_->steady_time : 0;
  last_ = Look{ros_now, steady_now};
  if (set) {
    set_at_ = ros_now;
  }
  return set;
}

bool ClockWatch::isStale(std::int64_t stamp) const {
  return set_at_ && (stamp < *set_at_ - kLatestEvent || stamp > last_->ros_time + kLatestEvent);
}

}  // namespace self_awareness::core
