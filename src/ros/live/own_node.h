#pragma once

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

}  // namespace self_awareness::ros1
