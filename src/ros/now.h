#pragma once

#include <ros/time.h>

#include <cstdint>

namespace self_awareness {

/// ROS time [ns]; 0 before simulated time has begun.
inline std::int64_t rosNow() {
  return static_cast<std::int64_t>(ros::Time::now().toNSec());
}

/// Time that nobody sets, since the start of the machine [ns].
inline std::int64_t steadyNow() {
  return static_cast<std::int64_t>(ros::SteadyTime::now().toNSec());
}

/// Time since 1970, simulated or not [ns].
inline std::int64_t wallNow() {
  return static_cast<std::int64_t>(ros::WallTime::now().toNSec());
}

}  // namespace self_awareness
