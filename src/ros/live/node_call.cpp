#include "node_call.h"

#include <ros/network.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <istream>

namespace self_awareness::ros1 {

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
