#pragma once

#include <string>

namespace self_awareness::ros1 {

/// A node's name without the number that makes it anonymous and changes with every start: roscpp
/// appends _<nanoseconds>, rospy _<pid>_<milliseconds>, roslaunch's $(anon) _<pid>_<random>.
std::string stableName(const std::string& name);

}  // namespace self_awareness::ros1
