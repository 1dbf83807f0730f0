#include "ros/live/hanging_nodes.h"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <set>
#include <string>
#include <thread>

namespace self_awareness::ros1 {
namespace {

using boost::asio::ip::tcp;

/// Takes connections at a port of its own.
class Server {
 public:
  std::string uri() const {
    return "http://127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port()) + "/";
  }
  void answerOnce() {
    tcp::socket socket(context_);
    acceptor_.accept(socket);
    boost::asio::write(socket, boost::asio::buffer(std::string("HTTP/1.1 200 OK\r\n\r\n")));
  }
  void close() { acceptor_.close(); }

 private:
  boost::asio::io_context context_;
  tcp::acceptor acceptor_{context_, {boost::asio::ip::address_v4::loopback(), 0}};
};

TEST(HangingNodes, AreThoseThatTakeACallAndDoNotAnswer) {
  Server well;
  Server hung;
  Server dead;
  const std::string nobody = dead.uri();
  dead.close();
  std::thread answering([&] { well.answerOnce(); });
  EXPECT_EQ(
      hangingNodes(
          {{"/well", well.uri()}, {"/hung", hung.uri()}, {"/dead", nobody}, {"/unknown", ""}},
          std::chrono::milliseconds(300)),
      std::set<std::string>{"/hung"});
  answering.join();
}

}  // namespace
}  // namespace self_awareness::ros1
