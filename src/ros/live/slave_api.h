#pragma once

#include <chrono>
#include <set>
#include <string>
#include <utility>

namespace self_awareness::ros1 {

/// What this node's slave API says, and is told, as every node's does: wiki.ros.org/ROS/Slave_API.

/// URI of the slave API of this node.
std::string ownUri();

/// Host and port in a URI, by which roscpp tells nodes apart; the URI itself if it has none.
std::string addressIn(const std::string& uri);

/// Whom this node has connections to, by topic and address; they may be about to be made again.
std::set<std::pair<std::string, std::string>> connectedPublishers();

/// Tells roscpp who publishes a topic, as the master does (publisherUpdate): it connects to whom
/// it has no connection to, and closes those to others.
void tellPublishers(const std::string& topic, const std::set<std::string>& uris);

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
