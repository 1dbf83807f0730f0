#include "hanging_nodes.h"

#include <ros/network.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <boost/asio/ip/tcp.hpp>
#include <cstdint>

namespace self_awareness::ros1 {
namespace {

// XmlRpcClient waits for ever.
bool hangs(const std::string& host, std::uint32_t port, std::chrono::milliseconds patience) {
  namespace asio = boost::asio;
  const std::string call = "<methodCall><methodName>getPid</methodName><params><param>" +
                           XmlRpc::XmlRpcValue(ros::this_node::getName()).toXml() +
                           "</param></params></methodCall>";
  asio::ip::tcp::iostream node;
  node.expires_after(patience);
  node.connect(host, std::to_string(port));
  node << "POST / HTTP/1.1\r\nHost: " << host
       << "\r\nContent-Type: text/xml\r\nContent-Length: " << call.size() << "\r\n\r\n"
       << call << std::flush;
  node.get();
  return node.error() == asio::error::timed_out || node.error() == asio::error::operation_aborted;
}

}  // namespace

std::set<std::string> hangingNodes(const std::map<std::string, std::string>& addresses,
                                   std::chrono::milliseconds patience) {
  std::set<std::string> hanging;
  for (const auto& [node, uri] : addresses) {
    std::string host;
    std::uint32_t port = 0;
    if (ros::network::splitURI(uri, host, port) && hangs(host, port, patience)) {
      hanging.insert(node);
    }
  }
  return hanging;
}

}  // namespace self_awareness::ros1
