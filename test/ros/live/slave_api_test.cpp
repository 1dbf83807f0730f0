#include "ros/live/slave_api.h"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
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
    std::string request;  // who closes before it has read all resets the connection
    boost::asio::read_until(socket, boost::asio::dynamic_buffer(request), "</methodCall>");
    boost::asio::write(socket, boost::asio::buffer(std::string("HTTP/1.1 200 OK\r\n\r\n")));
  }
  void close() { acceptor_.close(); }

 private:
  boost::asio::io_context context_;
  tcp::acceptor acceptor_{context_, {boost::asio::ip::address_v4::loopback(), 0}};
};

TEST(NodeCall, IsAnsweredOrNotOrRefused) {
  constexpr std::chrono::milliseconds kPatience(300);
  Server well;
  std::thread answering([&] { well.answerOnce(); });
  EXPECT_EQ(callNode(well.uri(), kPatience), Answer::kGiven);
  answering.join();
  const Server hung;
  EXPECT_EQ(callNode(hung.uri(), kPatience), Answer::kNone);
  Server dead;
  const std::string nobody = dead.uri();
  dead.close();
  EXPECT_EQ(callNode(nobody, kPatience), Answer::kRefused);
  EXPECT_EQ(callNode("", kPatience), Answer::kRefused);
}

}  // namespace
}  // namespace self_awareness::ros1
