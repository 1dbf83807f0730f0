#include "self_awareness/ros/dropped_messages.h"

#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcException.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace self_awareness::ros1 {

std::uint64_t DroppedMessages::count() {
  XmlRpc::XmlRpcClient self(ros::network::getHost().c_str(),
                            static_cast<int>(ros::XMLRPCManager::instance()->getServerPort()));
  XmlRpc::XmlRpcValue request;
  request[0] = ros::this_node::getName();
  XmlRpc::XmlRpcValue response;
  if (!self.execute("getBusStats", request, response)) {
    return total_;
  }
  try {
    // [publications, subscriptions, services], which the slave API wants behind a code and a
    // message, but roscpp sends bare. A subscription is [topic, [[connection, bytes, messages,
    // drops, 0], ...]].
    XmlRpc::XmlRpcValue& statistics =
        response.size() == 3 && response[0].getType() == XmlRpc::XmlRpcValue::TypeInt ? response[2]
                                                                                      : response;
    XmlRpc::XmlRpcValue& subscriptions = statistics[1];
    for (int i = 0; i < subscriptions.size(); ++i) {
      const std::string topic = subscriptions[i][0];
      XmlRpc::XmlRpcValue& connections = subscriptions[i][1];
      for (int k = 0; k < connections.size(); ++k) {
        const std::int64_t drops = static_cast<int>(connections[k][3]);
        std::int64_t& known = by_connection_[{topic, static_cast<int>(connections[k][0])}];
        total_ += static_cast<std::uint64_t>(drops > known ? drops - known : 0);
        known = drops;
      }
    }
  } catch (const XmlRpc::XmlRpcException&) {
    return total_;  // another roscpp's layout: what is known stays
  }
  return total_;
}

}  // namespace self_awareness::ros1
