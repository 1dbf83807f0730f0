#pragma once

#include <ros/time.h>

#include <cstdint>

namespace self_awareness::ros1 {

/// A stamp [ns] as ROS time, which begins in 1970 and ends in 2106: what lies outside becomes the
/// first or the last time that there is. ros::Time itself throws at that, and a clock may have
/// been set to its end.
ros::Time toRosTime(std::int64_t stamp);
/// ROS time as a stamp [ns].
inline std::int64_t fromRosTime(const ros::Time& time) {
  return static_cast<std::int64_t>(time.toNSec());
}

}  // namespace self_awareness::ros1
