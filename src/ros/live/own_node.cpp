#include "own_node.h"

#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace self_awareness::ros1 {
namespace {

using XmlRpc::XmlRpcValue;

// What it answers; not valid if it does not.
XmlRpcValue call(const char* method, XmlRpcValue request) {
  std::string host;
  std::uint32_t port = 0;
  request[0] = ros::this_node::getName();
  XmlRpcValue answer;  // code, words, value
  if (ros::network::splitURI(ownUri(), host, port)) {
    XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
    client.execute(method, request, answer);
  }
  return answer.getType() == XmlRpcValue::TypeArray && answer.size() == 3 ? answer[2]
                                                                          : XmlRpcValue();
}

}  // namespace

std::string ownUri() {
  return ros::XMLRPCManager::instance()->getServerURI();
}

std::string addressIn(const std::string& uri) {
  std::string host;
  std::uint32_t port = 0;
  return ros::network::splitURI(uri, host, port) ? host + ":" + std::to_string(port) : uri;
}

std::set<std::pair<std::string, std::string>> connectedPublishers() {
  std::set<std::pair<std::string, std::string>> connected;
  XmlRpcValue connections = call("getBusInfo", {});
  const int number = connections.getType() == XmlRpcValue::TypeArray ? connections.size() : 0;
  for (int i = 0; i < number; ++i) {
    XmlRpcValue& each = connections[i];  // id, URI of the other node, direction, transport, topic
    if (static_cast<std::string>(each[2]) == "i") {
      connected.insert({each[4], addressIn(each[1])});
    }
  }
  return connected;
}

void tellPublishers(const std::string& topic, const std::set<std::string>& uris) {
  XmlRpcValue request;
  request[1] = topic;
  request[2].setSize(0);
  for (const std::string& uri : uris) {
    request[2][request[2].size()] = uri;
  }
  call("publisherUpdate", request);
}

}  // namespace self_awareness::ros1
