#pragma once

#include <string>

namespace self_awareness::ros1 {

/// The whole name of a node or a topic, as ROS resolves it at the root: it begins with a slash,
/// has none at its end, and no two in a row. `rosbag record scan` writes "scan" for /scan. What
/// begins with another character than a name may (as "~", or what stands for several) stays as it
/// is.
std::string resolvedName(const std::string& name);

/// A node's whole name without the number that makes it anonymous and changes with every start:
/// roscpp appends _<nanoseconds>, rospy _<pid>_<milliseconds>, roslaunch's $(anon)
/// _<pid>_<random>.
std::string stableName(const std::string& name);

}  // namespace self_awareness::ros1
