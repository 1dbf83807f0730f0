#include "ros/verdict/verdict_message.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace self_awareness::ros1 {
namespace {

using Reason = core::Suspect::Reason;

class VerdictMessageTest : public testing::Test {
 protected:
  VerdictMessageTest() {
    vocabulary_.intern({"/player", "/scan", "sensor_msgs/LaserScan"});
    vocabulary_.intern({"/player", "/rosout", "rosgraph_msgs/Log[level=8]"});
    vocabulary_.intern({"", "/markers", "visualization_msgs/Marker[action=2]"});
  }
  self_awareness::Suspect message(core::EventId id, Reason reason) const {
    core::Suspect suspect;
    suspect.id = id;
    suspect.reason = reason;
    suspect.events = 3;
    return toMessages({suspect}, vocabulary_).at(0);
  }

  core::Vocabulary vocabulary_;
};

TEST_F(VerdictMessageTest, TellsTheSilence) {
  core::Suspect suspect;
  suspect.silence = 2.5;
  suspect.usual_shortest = 0.07;
  suspect.usual_longest = 0.09;
  const self_awareness::Suspect message = toMessages({suspect}, vocabulary_).at(0);
  EXPECT_EQ(message.source, "/player");
  EXPECT_EQ(message.scope, "/scan");
  EXPECT_EQ(message.type, "sensor_msgs/LaserScan");
  EXPECT_EQ(message.reason, core::describe(suspect));
  EXPECT_EQ(message.silence, 2.5);
  EXPECT_EQ(message.usual_shortest, 0.07);
  EXPECT_EQ(message.usual_longest, 0.09);
}

TEST_F(VerdictMessageTest, ASuspectThatIsNotSilentHasNoSilence) {
  for (const Reason reason : {Reason::kUnknown, Reason::kRate, Reason::kUnanswered}) {
    const self_awareness::Suspect suspect = message(0, reason);
    EXPECT_TRUE(std::isnan(suspect.silence));
    EXPECT_TRUE(std::isnan(suspect.usual_shortest));
    EXPECT_TRUE(std::isnan(suspect.usual_longest));
  }
}

TEST_F(VerdictMessageTest, AChannelHasWordsOfItsOwn) {
  core::Suspect suspect;
  suspect.reason = Reason::kOther;
  suspect.words = "in bursts";
  const self_awareness::Suspect message = toMessages({suspect}, vocabulary_).at(0);
  EXPECT_EQ(message.reason, "in bursts");
  EXPECT_EQ(describe(message), "/player on /scan: in bursts");
}

TEST_F(VerdictMessageTest, SaysWhichValueOfATypeFieldItIsAbout) {
  EXPECT_EQ(describe(message(1, Reason::kUnknown)),
            "/player on /rosout [level=8]: never seen in training, 3 in this window");
  EXPECT_EQ(describe(message(2, Reason::kUnknown)),
            "/markers [action=2]: never seen in training, 3 in this window");
  EXPECT_EQ(describe(message(0, Reason::kUnknown)),
            "/player on /scan: never seen in training, 3 in this window");
  EXPECT_EQ(describeOnScope(message(1, Reason::kUnknown)),
            "/rosout [level=8]: never seen in training, 3 in this window");
}

TEST_F(VerdictMessageTest, ABusyMachineIsNamedBeforeTheSuspects) {
  core::Verdict verdict;
  verdict.threshold = -1;
  verdict.alarm = true;
  EXPECT_EQ(
      wording(verdict, "busy, pairs", {message(1, Reason::kUnknown)}, {},
              core::describe(core::Busy{12, 26}, "load 7.9 on 2 cores")),
      "abnormal communication (busy, pairs), the machine may be busy (load 7.9 on 2 cores): "
      "12 of 26 components are late, /player on /rosout [level=8]: never seen in training, 3 "
      "in this window");
}

}  // namespace
}  // namespace self_awareness::ros1
