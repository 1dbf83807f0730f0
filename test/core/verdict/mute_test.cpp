#include "self_awareness/core/verdict/mute.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace self_awareness::core {
namespace {

class MutesTest : public testing::Test {
 protected:
  MutesTest()
      : vocabulary_({{"/player", "/scan", "T"}, {"/slam", "/pose", "T"}, {"/camera", "/i", "T"}}) {
    graph_.connect("/player", "/scan", "/slam");
  }

  static Mute mute(const std::string& component, const std::string& topic = "",
                   std::optional<Kind> kind = std::nullopt) {
    Mute mute;
    mute.component = component;
    mute.topic = topic;
    mute.kind = kind;
    mute.until = 100;
    return mute;
  }
  /// An alarm about event types of the vocabulary, all abnormal; the first is the culprit's.
  std::optional<Alarm> alarm(const std::vector<EventId>& ids, std::uint64_t id = 1) const {
    Alarm alarm;
    alarm.id = id;
    alarm.level = Alarm::Level::kAlarm;
    for (const EventId each : ids) {
      Suspect suspect;
      suspect.id = each;
      suspect.component = vocabulary_.at(each).source;
      suspect.abnormal = true;
      alarm.suspects.push_back(suspect);
    }
    alarm.culprit = alarm.suspects.empty() ? "" : alarm.suspects.front().component;
    return alarm;
  }
  /// Whether it is muted.
  bool stands(const std::optional<Alarm>& alarm) {
    ended_ = mutes_.onStanding(alarm, vocabulary_, graph_);
    return mutes_.active() != nullptr;
  }

  Vocabulary vocabulary_;
  SourceGraph graph_;
  Mutes mutes_;
  std::vector<Mute> ended_;
};

TEST_F(MutesTest, AComponentIsMutedWithItsVictims) {
  EXPECT_FALSE(stands(alarm({0})));
  mutes_.add(mute("/player"));
  EXPECT_TRUE(stands(alarm({0, 1})));
  EXPECT_FALSE(stands(alarm({2}))) << "another one";
  EXPECT_FALSE(stands(alarm({0, 2}))) << "another one fails, too";
  EXPECT_FALSE(stands(alarm({1}))) << "a victim may fail of itself";
  mutes_.add(mute("/cam*"));
  EXPECT_TRUE(stands(alarm({0, 2})));
  EXPECT_TRUE(stands(alarm({2})));
  EXPECT_FALSE(stands(std::nullopt));
}

TEST_F(MutesTest, WhoFailsLaterThanWhatIsMutedIsTold) {
  mutes_.add(mute("/player"));
  for (const bool resumed : {false, true}) {  // of the one of before the start no suspect is known
    std::optional<Alarm> grows = resumed ? alarm({}) : alarm({0});
    grows->culprit = "/player";
    EXPECT_TRUE(stands(grows));
    grows->later = alarm({1})->suspects;
    EXPECT_TRUE(stands(grows)) << "a victim";
    grows->later = alarm({2})->suspects;
    EXPECT_FALSE(stands(grows));
    EXPECT_FALSE(stands(grows)) << "the same again";
  }
}

TEST_F(MutesTest, ATopicOrAKindOrAllIsMuted) {
  mutes_.add(mute("", "/scan"));
  EXPECT_TRUE(stands(alarm({0})));
  EXPECT_FALSE(stands(alarm({2})));
  mutes_.add(mute("", "", Kind::kSlow));
  std::optional<Alarm> slow = alarm({2});
  EXPECT_FALSE(stands(slow));
  slow->kind = slow->suspects[0].reason.kind = Kind::kSlow;
  EXPECT_TRUE(stands(slow));
  mutes_.add(mute("/player"));
  std::optional<Alarm> busy = alarm({});  // of nobody
  busy->kind = Kind::kBusyMachine;
  EXPECT_FALSE(stands(busy));
  mutes_.add(mute("", "", Kind::kBusyMachine));
  EXPECT_TRUE(stands(busy));
  EXPECT_FALSE(stands(alarm({0, 1, 2})));
  EXPECT_TRUE(mutes_.add(mute(""))->mutesAll()) << "maintenance";
  EXPECT_TRUE(stands(alarm({0, 1, 2})));
  EXPECT_TRUE(stands(alarm({})));
}

TEST_F(MutesTest, WhatIsLeftOfAnAlarmIsMutedLikeIt) {
  mutes_.add(mute("", "/scan"));
  EXPECT_TRUE(stands(alarm({0})));
  std::optional<Alarm> left = alarm({}, 2);
  left->level = Alarm::Level::kSuspicion;
  left->culprit = "/player";
  EXPECT_TRUE(stands(left));
  EXPECT_EQ(mutes_.active()->suspicions, 1U);
}

TEST_F(MutesTest, WhatIsMutedIsCountedOnce) {
  mutes_.add(mute("/player"));
  stands(alarm({0}, 1));
  stands(alarm({0}, 1));
  stands(std::nullopt);
  stands(alarm({0}, 2));
  EXPECT_EQ(mutes_.active()->alarms, 2U);
  const std::vector<Mute> over = mutes_.advance(100);
  ASSERT_EQ(over.size(), 1U);
  EXPECT_EQ(over[0].alarms, 2U);
  EXPECT_FALSE(stands(alarm({0}, 2)));
}

TEST_F(MutesTest, EveryMuteEnds) {
  Mute until_over = mute("/player");
  until_over.until_over = true;
  mutes_.add(until_over);
  mutes_.add(mute("/camera"));
  EXPECT_TRUE(mutes_.advance(99).empty());
  EXPECT_FALSE(stands(std::nullopt));
  EXPECT_TRUE(ended_.empty()) << "it has muted nothing yet";
  stands(alarm({0}));
  stands(std::nullopt);
  ASSERT_EQ(ended_.size(), 1U);
  EXPECT_EQ(ended_[0].component, "/player");
  stands(alarm({2}));
  stands(std::nullopt);
  EXPECT_TRUE(ended_.empty()) << "that of the camera goes on";
  ASSERT_EQ(mutes_.advance(100).size(), 1U);
  EXPECT_TRUE(mutes_.list().empty());
}

TEST_F(MutesTest, AMuteIsReplacedOrTakenBackAndTheirNumberIsBounded) {
  Mute longer = mute("/player");
  longer.until = 200;
  mutes_.add(mute("/player"));
  EXPECT_TRUE(mutes_.add(longer));
  EXPECT_TRUE(mutes_.advance(100).empty());
  for (std::size_t i = 1; i < Mutes::kMost; ++i) {
    EXPECT_TRUE(mutes_.add(mute("/n" + std::to_string(i))));
  }
  EXPECT_FALSE(mutes_.add(mute("/one_more")));
  EXPECT_TRUE(mutes_.add(mute("/n7"))) << "it replaces another one";
  EXPECT_FALSE(mutes_.end(mute("/player", "/scan"))) << "there is none like it";
  EXPECT_TRUE(mutes_.end(mute("/player")));
  EXPECT_EQ(mutes_.list().size(), Mutes::kMost - 1);
}

TEST_F(MutesTest, WhatIsOverDoesNotEndWhatIsRenewedLater) {
  mutes_.add(mute("/player"));
  stands(alarm({0}));
  stands(std::nullopt);
  Mute until_over = mute("/player");
  until_over.until_over = true;
  mutes_.add(until_over);
  EXPECT_FALSE(stands(std::nullopt));
  EXPECT_TRUE(ended_.empty()) << "it waits for the next alarm";
  stands(alarm({0}, 2));
  stands(std::nullopt);
  ASSERT_EQ(ended_.size(), 1U);
  EXPECT_EQ(ended_[0].alarms, 2U);
}

TEST_F(MutesTest, SomebodyElseDoesNotShortenIt) {
  Mute of_operator = mute("/player");
  of_operator.by = "/rqt";
  Mute of_recovery = mute("/player");
  of_recovery.by = "/recovery";
  of_recovery.until = 20;
  mutes_.add(of_operator);
  EXPECT_EQ(mutes_.add(of_recovery)->until, 100);
  EXPECT_TRUE(mutes_.advance(99).empty());
  EXPECT_EQ(mutes_.list()[0].by, "/rqt");
  of_operator.until = 30;
  EXPECT_EQ(mutes_.add(of_operator)->until, 30) << "who asked for it may shorten it";
  of_recovery.until = 40;
  EXPECT_EQ(mutes_.add(of_recovery)->by, "/recovery") << "it is for longer";
  EXPECT_EQ(mutes_.list().size(), 1U);
}

TEST_F(MutesTest, AllOfAComponentIsMutedByItsNameOrByMaintenance) {
  mutes_.add(mute("/player", "/scan"));
  mutes_.add(mute("/player", "", Kind::kSlow));
  EXPECT_EQ(mutes_.ofComponent("/player"), nullptr) << "a part of it";
  mutes_.add(mute("/pl*"));
  ASSERT_NE(mutes_.ofComponent("/player"), nullptr);
  EXPECT_EQ(mutes_.ofComponent("/player")->component, "/pl*");
  EXPECT_EQ(mutes_.ofComponent("/camera"), nullptr);
  mutes_.add(mute(""));
  EXPECT_NE(mutes_.ofComponent("/camera"), nullptr);
}

}  // namespace
}  // namespace self_awareness::core
