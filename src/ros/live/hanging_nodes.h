#pragma once

#include <chrono>
#include <map>
#include <set>
#include <string>

namespace self_awareness::ros1 {

/// Asks the slave APIs of nodes for their process ids (getPid: wiki.ros.org/ROS/Slave_API), one
/// after the other, and waits for each.
/// @param addresses URIs of the slave APIs, by node
/// @param patience how long each has to answer
/// @return who does not, though his machine does not refuse the call, as it does of who is dead
std::set<std::string> hangingNodes(const std::map<std::string, std::string>& addresses,
                                   std::chrono::milliseconds patience);

}  // namespace self_awareness::ros1
