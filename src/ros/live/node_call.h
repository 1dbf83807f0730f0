#pragma once

#include <chrono>
#include <string>

namespace self_awareness::ros1 {

/// What a node does that is called.
enum class Answer {
  kGiven,   ///< it answers
  kNone,    ///< it hangs: its machine takes the call, and nothing comes
  kRefused  ///< it is dead, or nobody knows where it is
};

/// Asks the slave API of a node for its process id (getPid: wiki.ros.org/ROS/Slave_API), and waits
/// for it, and for whoever knows the address of its host.
/// @param uri of the slave API
/// @param patience how long it has to answer
Answer callNode(const std::string& uri, std::chrono::milliseconds patience);

}  // namespace self_awareness::ros1
