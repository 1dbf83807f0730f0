#include "ros/verdict/verdict_message.h"

#include <gtest/gtest.h>

#include <cmath>

#include "self_awareness/SelfAwareness.h"

namespace self_awareness::ros1 {
namespace {

using core::Kind;

class VerdictMessageTest : public testing::Test {
 protected:
  VerdictMessageTest() {
    vocabulary_.intern({"/player", "/scan", "sensor_msgs/LaserScan"});
    vocabulary_.intern({"/player", "/rosout", "rosgraph_msgs/Log[level=8]"});
    vocabulary_.intern({"", "/markers", "visualization_msgs/Marker[action=2]"});
  }
  self_awareness::Suspect message(core::EventId id, const core::Reason& reason) const {
    core::Suspect suspect;
    suspect.id = id;
    suspect.reason = reason;
    return toMessages({suspect}, vocabulary_).at(0);
  }
  self_awareness::Suspect stranger(core::EventId id) const {
    return message(id, core::strangerIn(3));
  }

  core::Vocabulary vocabulary_;
};

TEST_F(VerdictMessageTest, TellsTheSilence) {
  core::Reason reason;
  reason.unit = core::unit::kSeconds;
  reason.value = 2.5;
  reason.usual = 0.08;
  reason.usual_shortest = 0.07;
  reason.usual_longest = 0.09;
  reason.words = "silent for 2.5 s";
  const self_awareness::Suspect message = this->message(0, reason);
  EXPECT_EQ(message.source, "/player");
  EXPECT_EQ(message.scope, "/scan");
  EXPECT_EQ(message.type, "sensor_msgs/LaserScan");
  EXPECT_EQ(message.component, "/player");
  EXPECT_EQ(message.kind, self_awareness::SelfAwareness::SILENT);
  EXPECT_EQ(message.reason, reason.words);
  EXPECT_EQ(message.unit, "s");
  EXPECT_EQ(message.value, 2.5);
  EXPECT_EQ(message.usual, 0.08);
  EXPECT_EQ(message.silence, 2.5);
  EXPECT_EQ(message.usual_shortest, 0.07);
  EXPECT_EQ(message.usual_longest, 0.09);
}

TEST_F(VerdictMessageTest, OnlyWhoIsSilentHasASilenceAlsoOneThatIsCountedInRequests) {
  core::Reason requests;
  requests.kind = Kind::kSilent;
  requests.unit = core::unit::kRequests;
  requests.value = 3;
  EXPECT_TRUE(std::isnan(message(0, requests).silence)) << "it was not heard so far";
  requests.silence = 1.5;
  EXPECT_EQ(message(0, requests).silence, 1.5);
  for (const Kind kind : {Kind::kSlow, Kind::kFast}) {
    core::Reason reason;
    reason.kind = kind;
    reason.unit = core::unit::kHertz;
    reason.value = 3;
    reason.usual_shortest = 5;
    reason.usual_longest = 6;
    const self_awareness::Suspect suspect = message(0, reason);
    EXPECT_EQ(suspect.value, 3);
    EXPECT_TRUE(std::isnan(suspect.silence));
    EXPECT_TRUE(std::isnan(suspect.usual_shortest));
    EXPECT_TRUE(std::isnan(suspect.usual_longest));
  }
}

TEST_F(VerdictMessageTest, SaysWhichValueOfATypeFieldItIsAbout) {
  EXPECT_EQ(describe(stranger(1)),
            "/player on /rosout [level=8]: never seen in training, 3 in this window");
  EXPECT_EQ(describe(stranger(2)),
            "/markers [action=2]: never seen in training, 3 in this window");
  EXPECT_EQ(describe(stranger(0)), "/player on /scan: never seen in training, 3 in this window");
  EXPECT_EQ(describeOnScope(stranger(1)),
            "/rosout [level=8]: never seen in training, 3 in this window");
}

TEST_F(VerdictMessageTest, TheSentenceOfTheAlarmComesFirst) {
  core::Verdict verdict;
  verdict.threshold = -1;
  core::Alarm alarm;
  alarm.kind = Kind::kBusyMachine;
  alarm.begin = 1'600'000'000'000'000'000;
  const std::string busy = describe(core::Busy{12, 26}, "load 7.9 on 2 cores");
  EXPECT_EQ(wording(verdict, alarm, "busy, pairs", {stranger(1)}, busy),
            "the machine may be busy (load 7.9 on 2 cores): 12 of 26 components are late, since "
            "12:26:40 UTC (busy, pairs); now also /player on /rosout [level=8]: never seen in "
            "training, 3 in this window");
  alarm.kind = Kind::kSlow;
  alarm.culprit = "/imu";
  EXPECT_EQ(wording(verdict, alarm, "rate", {}, busy),
            "/imu sends too seldom since 12:26:40 UTC; " + busy + " (rate)");
  EXPECT_EQ(wording(verdict, std::nullopt, "", {}), "normal communication");
}

// Programs compare with the strings of the message.
TEST(Kinds, AreThoseOfTheMessage) {
  using Message = self_awareness::SelfAwareness;
  EXPECT_EQ(core::toString(Kind::kSilent), Message::SILENT);
  EXPECT_EQ(core::toString(Kind::kTopicSilent), Message::TOPIC_SILENT);
  EXPECT_EQ(core::toString(Kind::kUnanswered), Message::UNANSWERED);
  EXPECT_EQ(core::toString(Kind::kSlow), Message::SLOW);
  EXPECT_EQ(core::toString(Kind::kFast), Message::FAST);
  EXPECT_EQ(core::toString(Kind::kLate), Message::LATE);
  EXPECT_EQ(core::toString(Kind::kEarly), Message::EARLY);
  EXPECT_EQ(core::toString(Kind::kOutOfOrder), Message::OUT_OF_ORDER);
  EXPECT_EQ(core::toString(Kind::kNeverCame), Message::NEVER_CAME);
  EXPECT_EQ(core::toString(Kind::kStranger), Message::STRANGER);
  EXPECT_EQ(core::toString(Kind::kUnsubscribed), Message::NOT_SUBSCRIBED);
  EXPECT_EQ(core::toString(Kind::kBusyMachine), Message::BUSY_MACHINE);
  EXPECT_EQ(core::toString(Kind::kAllSilent), Message::ALL_SILENT);
  EXPECT_EQ(core::toString(Kind::kNewMode), Message::NEW_MODE);
  EXPECT_EQ(core::toString(Kind::kTwoSenders), Message::TWO_SENDERS);
  EXPECT_EQ(core::toString(Kind::kSlowerClock), Message::SLOWER_CLOCK);
}

}  // namespace
}  // namespace self_awareness::ros1
