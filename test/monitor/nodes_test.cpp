// What the monitor finds out about nodes: who is not heard, who blocks another one, who was
// started again.

#include <gtest/gtest.h>

#include "../times.h"
#include "monitor/blocked_node.h"
#include "monitor/not_heard.h"
#include "monitor/restart_watch.h"

namespace self_awareness {
namespace {

TEST(NotHeard, WhoMayBeAbsentIsNamedAsTheModelNamesHim) {
  ros1::EncodingRules rules;
  rules.renames = {{"/r[0-9]+/(.*)", "/\\1"}};
  const std::vector<ros1::Unheard> unheard{{"/r7/joystick", "/r7/joy", "", false},
                                           {"/r7/arm_1764000000000", "/r7/gripper", "", false},
                                           {"/r7/player", "/r7/scan", "", false}};
  core::Acceptances accepted;
  core::Acceptance one;
  one.kind = core::Kind::kNeverCame;
  for (const char* name : {"/joy*", "/arm"}) {
    one.component = name;
    accepted.add(one);
  }
  one.component.clear();
  one.topic = "/gripper";
  accepted.add(one);
  const std::vector<ros1::Unheard> left =
      withoutOptional(unheard, accepted, ros1::Encoder(rules, nullptr));
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left[0].node, "/r7/player");
}

using ros1::Answer;

TEST(WhoBlocks, IsASubscriberThatHangsIfTheSilentNodeAnswers) {
  Discovery::Answers answers{{"/cam", Answer::kGiven},
                             {"/viewer", Answer::kNone},
                             {"/rviz", Answer::kNone},
                             {"/detector", Answer::kGiven},
                             {"/gone", Answer::kRefused}};
  EXPECT_EQ(whoBlocks({"/cam"}, {"/viewer", "/detector", "/gone"}, answers),
            "it answers, but its subscriber /viewer does not");
  EXPECT_EQ(whoBlocks({"/cam"}, {"/viewer", "/rviz"}, answers),
            "it answers, but its subscribers /rviz and /viewer do not");
  EXPECT_EQ(whoBlocks({"/cam"}, {"/detector", "/gone"}, answers), "");
  EXPECT_EQ(whoBlocks({"/cam"}, {"/not_asked"}, answers), "");
}

TEST(WhoBlocks, IsNobodyIfTheSilentNodeDoesNotAnswer) {
  Discovery::Answers answers{{"/viewer", Answer::kNone}};
  EXPECT_EQ(whoBlocks({"/cam"}, {"/viewer"}, answers), "") << "nobody had time to ask it";
  for (const Answer answer : {Answer::kNone, Answer::kRefused}) {
    answers["/cam"] = answer;
    EXPECT_EQ(whoBlocks({"/cam"}, {"/viewer"}, answers), "");
  }
}

using Nodes = std::vector<std::string>;
using Addresses = std::map<std::string, std::string>;

Nodes see(Restarts& restarts, const Addresses& addresses, std::int64_t now,
          const std::string& when) {
  ros1::EncodingRules rules = ros1::EncodingRules::defaults();
  rules.renames = {{"/r[0-9]+/(.*)", "/\\1"}};
  return restarts.see(addresses, ros1::Encoder(rules, nullptr), now, when);
}

TEST(Restarts, AnotherAddressIsARestartAndTheLineComesWhenAllIsAsUsual) {
  Restarts restarts(5 * kSecond);
  EXPECT_EQ(see(restarts, {{"/player", "http://a:1"}}, 0, "0"), Nodes()) << "it is new";
  EXPECT_EQ(see(restarts, {{"/player", "http://a:1"}}, kSecond, "1"), Nodes());
  EXPECT_EQ(see(restarts, {}, 2 * kSecond, "2"), Nodes()) << "it has gone";
  EXPECT_EQ(see(restarts, {{"/player", "http://a:2"}}, 3 * kSecond, "3"), Nodes{"/player"});
  EXPECT_EQ(restarts.advance(60 * kSecond, {}), Nodes()) << "it is not heard";
  restarts.onHeard("/player", 61 * kSecond);
  restarts.onHeard("/player", 64 * kSecond);
  EXPECT_EQ(restarts.advance(65 * kSecond, {}), Nodes());
  EXPECT_EQ(restarts.advance(66 * kSecond, {"/player"}), Nodes()) << "it is not as usual";
  EXPECT_EQ(restarts.advance(67 * kSecond, {"/slam"}),
            Nodes{"/player restarted at 3, back as usual"});
  EXPECT_EQ(restarts.advance(68 * kSecond, {}), Nodes()) << "it was said";
}

TEST(Restarts, AreCountedForTenMinutes) {
  Restarts restarts(0);
  for (int i = 0; i <= 7; ++i) {
    see(restarts, {{"/player", "http://a:" + std::to_string(i)}}, i * kSecond, "then");
  }
  EXPECT_EQ(restarts.count("/player", 7 * kSecond), 7U);
  EXPECT_EQ(restarts.inWords("/player", 7 * kSecond), "restarted 7 times in 10 min");
  EXPECT_EQ(restarts.count("/player", 605 * kSecond), 3U);
  EXPECT_EQ(restarts.inWords("/player", 700 * kSecond), "");
  EXPECT_EQ(restarts.inWords("/slam", 0), "");
}

TEST(Restarts, AreKnownByTheNamesOfTheModel) {
  Restarts restarts(5 * kSecond);
  for (const char* const address : {"http://a:1", "http://a:2"}) {
    EXPECT_EQ(see(restarts, {{"/r7/play_1_1600000000000", address}}, 0, "0"), Nodes())
        << "a player is left out";
  }
  EXPECT_EQ(see(restarts, {{"/r7/player", "http://a:1"}}, 0, "0"), Nodes());
  EXPECT_EQ(see(restarts, {{"/r7/player", "http://a:2"}}, kSecond, "1"), Nodes{"/player"});
  restarts.onHeard("/player", 2 * kSecond);
  EXPECT_EQ(restarts.advance(8 * kSecond, {}), Nodes{"/player restarted at 1, back as usual"});
}

TEST(Restarts, AreForgottenWhenTheClockIsSet) {
  Restarts restarts(0);
  see(restarts, {{"/player", "http://a:1"}}, 0, "then");
  see(restarts, {{"/player", "http://a:2"}}, 0, "then");
  restarts.onClockSet();
  EXPECT_EQ(restarts.count("/player", 0), 0U);
  restarts.onHeard("/player", 0);
  EXPECT_EQ(restarts.advance(kSecond, {}), Nodes());
}

}  // namespace
}  // namespace self_awareness
