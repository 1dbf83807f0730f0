#include "slave_api.h"

#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <istream>

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

// By hand, because XmlRpcClient waits for ever.
Answer callNode(const std::string& uri, std::chrono::milliseconds patience) {
  namespace asio = boost::asio;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) {
    return Answer::kRefused;
  }
  const std::string call = "<methodCall><methodName>getPid</methodName><params><param>" +
                           XmlRpc::XmlRpcValue(ros::this_node::getName()).toXml() +
                           "</param></params></methodCall>";
  asio::ip::tcp::iostream node;
  node.expires_after(patience);
  node.connect(host, std::to_string(port));
  node << "POST / HTTP/1.1\r\nHost: " << host
       << "\r\nContent-Type: text/xml\r\nContent-Length: " << call.size() << "\r\n\r\n"
       << call << std::flush;
  if (node.get() != std::istream::traits_type::eof()) {
    return Answer::kGiven;
  }
  const bool waited =
      node.error() == asio::error::timed_out || node.error() == asio::error::operation_aborted;
  return waited ? Answer::kNone : Answer::kRefused;
}

}  // namespace self_awareness::ros1
