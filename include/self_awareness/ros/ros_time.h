#pragma once

#include <ros/time.h>

#include <algorithm>
#include <cstdint>

namespace self_awareness::ros1 {

/// A stamp [ns] as ROS time, which begins in 1970 and ends in 2106: what lies outside becomes the
/// first or the last time that there is. ros::Time itself throws at that, and a clock may have
/// been set to its end.
inline ros::Time toRosTime(std::int64_t stamp) {
  const auto last = static_cast<std::int64_t>(ros::TIME_MAX.toNSec());
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(std::clamp<std::int64_t>(stamp, 0, last)));
  return time;
}
/// ROS time as a stamp [ns].
inline std::int64_t fromRosTime(const ros::Time& time) {
  return static_cast<std::int64_t>(time.toNSec());
}

/// ROS time [ns]; 0 before simulated time has begun.
inline std::int64_t rosNow() {
  return fromRosTime(ros::Time::now());
}
/// Time that nobody sets, since the start of the machine [ns].
inline std::int64_t steadyNow() {
  return static_cast<std::int64_t>(ros::SteadyTime::now().toNSec());
}
/// Time since 1970, simulated or not [ns].
inline std::int64_t wallNow() {
  return static_cast<std::int64_t>(ros::WallTime::now().toNSec());
}

}  // namespace self_awareness::ros1
