#include "self_awareness/ros/sender_watch.h"

#include <gtest/gtest.h>

#include "../times.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::int64_t kMillisecond = 1000000;
using Link = std::shared_ptr<SenderWatch::Link>;
using Doubled = std::set<core::SourceGraph::Publication>;

class SenderWatchTest : public testing::Test {
 protected:
  Link connect(const std::string& node, const std::string& topic = "/scan") {
    return watch_.connect({node, topic, "T", "", false, {}}, encoder_);
  }
  /// Messages of one, then of the other, and so on.
  void inTurn(const Link& one, const Link& other, std::optional<std::uint32_t> number = {},
              std::optional<std::uint32_t> of_other = {}, int times = 10) {
    for (int k = 0; k < times; ++k) {
      watch_.add(now_ += 40 * kMillisecond, *one, number);
      watch_.add(now_ += 40 * kMillisecond, *other, of_other);
      number = number ? std::optional<std::uint32_t>(*number + 1) : number;
      of_other = of_other ? std::optional<std::uint32_t>(*of_other + 1) : of_other;
    }
  }

  const Encoder encoder_{EncodingRules::defaults(), nullptr};
  core::Senders now_sends_;
  int told_ = 0;
  SenderWatch watch_{[this](std::int64_t, const core::Senders& senders) {
    now_sends_ = senders;
    ++told_;
  }};
  std::int64_t now_ = 0;
  const Doubled scan_{{"/lidar", "/scan"}};
};

TEST_F(SenderWatchTest, TwoConnectionsThatSpeakInTurnAreTwoSenders) {
  const Link one = connect("/lidar");
  const Link other = connect("/lidar");
  inTurn(one, other);
  EXPECT_EQ(now_sends_.doubled, scan_);
  EXPECT_EQ(told_, 1);
  for (int k = 0; k < 200; ++k) {
    watch_.add(now_ += 40 * kMillisecond, *one, std::nullopt);
  }
  EXPECT_TRUE(now_sends_.doubled.empty()) << "the other one has gone";
  inTurn(one, other);
  watch_.restart();
  EXPECT_TRUE(now_sends_.doubled.empty());
  EXPECT_EQ(told_, 4);
}

TEST_F(SenderWatchTest, WhoIsStartedAgainLosesMessagesOrStandsStillIsOne) {
  for (int start = 0; start < 10; ++start) {
    const Link link = connect("/lidar");
    for (std::uint32_t k = 0; k < 20; ++k) {
      watch_.add(now_ += 40 * kMillisecond, *link, k);
    }
  }
  const Link link = connect("/sonar");
  for (const std::uint32_t number :
       {1U, 2U, 4U, 5U, 9U, 10U, 11U, 0U, 1U, 2U, 3U, 7U, 8U, 0U, 1U}) {
    watch_.add(now_ += 40 * kMillisecond, *link, number);
  }
  for (int k = 0; k < 20; ++k) {
    watch_.add(now_ += 40 * kMillisecond, *link, 0);
  }
  inTurn(connect("/tool_1_1700000000000"), connect("/tool_2_1700000000001"));
  inTurn(connect("/lidar", "/scan"), connect("/lidar", "/cloud"));
  inTurn(connect("/lidar"), connect("/sonar"));
  EXPECT_EQ(told_, 0) << "nor are nodes of other numbers, topics and names";
}

TEST_F(SenderWatchTest, TwoCountsOnOneConnectionAreTwoSendersEvenIfTheyCountAlike) {
  for (const std::uint32_t of_other : {5000U, 100U}) {
    watch_.restart();
    const Link link = connect("/lidar");
    inTurn(link, link, 100, of_other);
    EXPECT_EQ(now_sends_.doubled, scan_) << of_other;
  }
}

TEST_F(SenderWatchTest, APlayerPlaysUntilItIsSilent) {
  for (const char* node : {"/play_1511950934432423423", "/robot/play_17", "/play"}) {
    const Link link = connect(node);
    ASSERT_TRUE(link) << node;
    watch_.add(now_ += kSecond, *link, std::nullopt);
    EXPECT_EQ(now_sends_.played, std::set<core::EventType>({{node, "/scan", "T"}}));
    watch_.advance(now_ += 6 * kSecond);
    EXPECT_TRUE(now_sends_.played.empty());
  }
  EXPECT_FALSE(connect("/play_17", "/rosout")) << "that is its own log";
  EXPECT_FALSE(connect("/play_17", "/clock"));
  EXPECT_FALSE(connect("/record_1511950934432423423"));
  const Link driver = connect("/player_17");
  watch_.add(now_ += kSecond, *driver, std::nullopt);
  EXPECT_TRUE(now_sends_.played.empty()) << "a node of the robot";
}

}  // namespace
}  // namespace self_awareness::ros1
