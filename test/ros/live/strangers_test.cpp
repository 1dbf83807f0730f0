#include "self_awareness/ros/live/strangers.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

namespace self_awareness::ros1 {
namespace {

constexpr std::int64_t kSecond = 1000000000;

/// A port, and connections to it.
class StrangersTest : public testing::Test {
 protected:
  StrangersTest() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(bind(server_, any, size), 0);
    EXPECT_EQ(listen(server_, 300), 0);
    EXPECT_EQ(getsockname(server_, any, &size), 0);
    port_ = ntohs(address.sin_port);
  }
  ~StrangersTest() override {
    for (const Pair& pair : pairs_) {
      close(pair.here);
      close(pair.there);
    }
    close(server_);
  }

  struct Pair {
    int here;
    int there;
  };
  Pair connection() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    const int there = socket(AF_INET, SOCK_STREAM, 0);
    EXPECT_EQ(connect(there, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    pairs_.push_back({accept(server_, nullptr, nullptr), there});
    return pairs_.back();
  }
  /// Says so many bytes, and waits until they have come.
  static void say(int from, int to, std::size_t bytes) {
    const std::string part(std::min<std::size_t>(bytes, 65536), 'x');
    std::string received(part.size(), ' ');
    for (std::size_t said = 0; said < bytes; said += part.size()) {
      ASSERT_EQ(send(from, part.data(), part.size(), 0), static_cast<ssize_t>(part.size()));
      ASSERT_EQ(recv(to, received.data(), part.size(), MSG_WAITALL),
                static_cast<ssize_t>(part.size()));
    }
  }
  static bool isClosed(int connection) {
    char byte = 0;
    return recv(connection, &byte, 1, MSG_DONTWAIT) == 0;
  }
  Strangers::Seen look(double second) {
    return strangers_.look(static_cast<std::int64_t>(second * kSecond), port_, port_ + 1);
  }

  const int server_ = socket(AF_INET, SOCK_STREAM, 0);
  int port_ = 0;
  std::vector<Pair> pairs_;
  Strangers strangers_;
};

TEST_F(StrangersTest, WhoSaysNothingIsCutOff) {
  const Pair idle = connection();
  const Pair answered = connection();
  look(0);
  say(answered.there, answered.here, 10);
  say(answered.here, answered.there, 10);
  EXPECT_EQ(look(4).closed, 0U);
  EXPECT_FALSE(isClosed(idle.there));
  EXPECT_EQ(look(5.1).closed, 1U);
  EXPECT_TRUE(isClosed(idle.there));
  EXPECT_EQ(look(1000).closed, 1U) << "this side has not closed it yet";
  EXPECT_FALSE(isClosed(answered.there));
}

// roscpp of Debian 13 accepts connections until there is no file left.
TEST_F(StrangersTest, WhereNoFileIsLeftTheyAreCutOffAllTheSame) {
  const Pair idle = connection();
  look(0);
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &limit), 0);
  const rlimit few{static_cast<rlim_t>(idle.here) + 50, limit.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
  std::vector<int> files;
  for (int file = 0; file >= 0; file = open("/dev/null", O_RDONLY | O_CLOEXEC)) {
    files.push_back(file);
  }
  const std::size_t closed = look(5.1).closed;
  std::for_each(std::next(files.begin()), files.end(), close);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
  EXPECT_EQ(closed, 1U);
  EXPECT_TRUE(isClosed(idle.there));
}

TEST_F(StrangersTest, WhoSaysTooMuchWithoutAnAnswerIsCutOff) {
  const Pair talkative = connection();
  look(0);
  for (int i = 0; i < 3; ++i) {  // who gets answers may go on
    say(talkative.there, talkative.here, Strangers::kMostUnanswered / 2);
    EXPECT_EQ(look(i).closed, 0U);
    say(talkative.here, talkative.there, 10);
    EXPECT_EQ(look(i + 0.5).closed, 0U);
  }
  say(talkative.there, talkative.here, Strangers::kMostUnanswered + 65536);
  EXPECT_EQ(look(5).closed, 1U);
  EXPECT_TRUE(isClosed(talkative.there));
}

TEST_F(StrangersTest, SomeMayStay) {
  std::vector<Pair> all;
  for (std::size_t i = 0; i < Strangers::kMost + 5; ++i) {
    all.push_back(connection());
    say(all.back().there, all.back().here, 1);
    say(all.back().here, all.back().there, 1000);
  }
  EXPECT_EQ(look(0).closed, 5U);
}

TEST_F(StrangersTest, ACallIsNoticed) {
  const Pair caller = connection();
  EXPECT_FALSE(look(0).called);
  say(caller.there, caller.here, 1);
  EXPECT_TRUE(look(1).called);
  EXPECT_FALSE(look(2).called);
}

}  // namespace
}  // namespace self_awareness::ros1
