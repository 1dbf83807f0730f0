#include "reachable.h"

#include <ros/network.h>

#include <boost/asio/ip/tcp.hpp>
#include <chrono>

#include "../text.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::chrono::milliseconds kPatience(500);

}  // namespace

Reachable::Reachable(const std::string& uri) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) {
    why_ = uri.empty() ? "the master does not know where it is" : "its address is none";
    return;
  }
  boost::asio::ip::tcp::iostream node;
  node.expires_after(kPatience);
  node.connect(host, std::to_string(port));
  const boost::system::error_code error = node.error();
  nobody_listens_ = error == boost::asio::error::connection_refused;
  if (nobody_listens_) {
    why_ = "nobody listens at its address";
  } else if (error == boost::asio::error::host_not_found ||
             error == boost::asio::error::host_not_found_try_again) {
    why_ = "nobody knows its host " + printable(host, kLongestName);
  } else {
    why_ = "does not answer";
  }
}

}  // namespace self_awareness::ros1
