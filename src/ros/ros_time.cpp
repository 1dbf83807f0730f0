#include "self_awareness/ros/ros_time.h"

#include <algorithm>

namespace self_awareness::ros1 {

ros::Time toRosTime(std::int64_t stamp) {
  static const auto kLast = static_cast<std::int64_t>(ros::TIME_MAX.toNSec());
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(std::min(std::max<std::int64_t>(stamp, 0), kLast)));
  return time;
}

}  // namespace self_awareness::ros1
