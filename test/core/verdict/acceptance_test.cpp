#include "self_awareness/core/verdict/acceptance.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace self_awareness::core {
namespace {

Acceptance accepted(const std::string& component, const std::string& topic,
                    std::optional<Kind> kind = std::nullopt) {
  Acceptance acceptance;
  acceptance.component = component;
  acceptance.topic = topic;
  acceptance.kind = kind;
  return acceptance;
}

TEST(Acceptances, WhatIsNamedMustAllFit) {
  Acceptances accepted_now;
  accepted_now.add(accepted("/rostopic*", "/cmd_vel", Kind::kStranger));
  EXPECT_TRUE(accepted_now.covers("/rostopic_12", "/cmd_vel", Kind::kStranger));
  EXPECT_FALSE(accepted_now.covers("/rostopic_12", "/scan", Kind::kStranger));
  EXPECT_FALSE(accepted_now.covers("/joystick", "/cmd_vel", Kind::kStranger));
  EXPECT_FALSE(accepted_now.covers("/rostopic_12", "/cmd_vel", Kind::kSlow)) << "once known";
}

Acceptance mode(const std::vector<std::string>& together) {
  Acceptance acceptance = accepted("", "", Kind::kNewMode);
  acceptance.together = together;
  return acceptance;
}

TEST(Acceptances, AModeCoversThatThoseOfItAreOffTogetherAndNoDeath) {
  Acceptances accepted_now;
  accepted_now.add(mode({"/arm", "/laser", "/lidar", "/wheels"}));
  EXPECT_TRUE(accepted_now.coversMode({"/arm", "/laser", "/lidar", "/wheels"}));
  EXPECT_TRUE(accepted_now.coversMode({"/arm", "/lidar"}));
  EXPECT_FALSE(accepted_now.coversMode({"/arm", "/imu"}));
  accepted_now.add(mode({"/imu"}));
  EXPECT_FALSE(accepted_now.coversMode({"/arm", "/imu"})) << "they are of two modes";
  EXPECT_FALSE(accepted_now.covers("/arm", "/joints", Kind::kDied));
  EXPECT_FALSE(accepted_now.covers("/arm", "/joints", Kind::kSlow));
  EXPECT_FALSE(accepted_now.covers("", "", Kind::kAllSilent));
  EXPECT_TRUE(accepted_now.list().front().isAbout("/arm", "/joints"));
  EXPECT_FALSE(accepted_now.list().front().isAbout("/imu", "/imu/data"));
  Acceptances death;
  death.add(accepted("/arm", ""));
  EXPECT_FALSE(death.coversMode({"/arm"}));
}

TEST(Acceptances, AModeIsTakenBackByItselfItsKindOrOneOfIt) {
  const Acceptance arm = mode({"/arm", "/laser"});
  const Acceptance imu = mode({"/imu", "/lidar"});
  const auto left = [&](const Acceptance& pattern) {
    Acceptances accepted_now;
    accepted_now.add(arm);
    accepted_now.add(imu);
    accepted_now.add(arm);  // replaces it
    accepted_now.add(accepted("/arm", ""));
    accepted_now.remove(pattern);
    return accepted_now.list().size();
  };
  EXPECT_EQ(left(arm), 2U);
  EXPECT_EQ(left(accepted("/arm", "")), 1U) << "what it does by itself, too";
  EXPECT_EQ(left(accepted("/i*", "")), 2U);
  EXPECT_EQ(left(accepted("", "", Kind::kNewMode)), 1U);
  EXPECT_EQ(left(accepted("/arm", "/joints")), 3U) << "a mode has no topic";
}

TEST(Acceptances, WhoIsSlowMayBeLateAndMayNotBeSilent) {
  Acceptances accepted_now;
  accepted_now.add(accepted("/camera", "", Kind::kSlow));
  for (const Kind kind :
       {Kind::kSlow, Kind::kFast, Kind::kLate, Kind::kEarly, Kind::kOutOfOrder}) {
    EXPECT_TRUE(accepted_now.covers("/camera", "/image", kind)) << toString(kind);
  }
  EXPECT_FALSE(accepted_now.covers("/camera", "/image", Kind::kDied));
  EXPECT_FALSE(accepted_now.covers("/camera", "/image", Kind::kNeverCame));
}

TEST(Acceptances, WhatMessagesAreLikeIsNoSilenceAndNoTime) {
  Acceptances accepted_now;
  accepted_now.add(accepted("/camera", "", Kind::kOtherSize));
  for (const Kind kind : {Kind::kStale, Kind::kLossy, Kind::kOtherSize, Kind::kStuck}) {
    EXPECT_TRUE(accepted_now.covers("/camera", "/image", kind)) << toString(kind);
  }
  for (const Kind kind : {Kind::kDied, Kind::kNeverCame, Kind::kSlow, Kind::kStranger}) {
    EXPECT_FALSE(accepted_now.covers("/camera", "/image", kind)) << toString(kind);
  }
}

TEST(Acceptances, OfConnectionsTheTopicIsTheOneThatIsNotSubscribedTo) {
  Acceptances accepted_now;
  accepted_now.add(accepted("/faces", "/image", Kind::kUnsubscribed));
  EXPECT_TRUE(accepted_now.covers("/faces", "/image", Kind::kUnsubscribed));
  EXPECT_FALSE(accepted_now.covers("/faces", "/depth", Kind::kUnsubscribed));
  EXPECT_FALSE(accepted_now.covers("/faces", "/image", Kind::kDied));
}

TEST(Acceptances, WhoMayBeSilentMayDoAnything) {
  for (const std::optional<Kind>& kind : {std::optional<Kind>(), {Kind::kDied}}) {
    Acceptances accepted_now;
    accepted_now.add(accepted("", "/image", kind));
    EXPECT_TRUE(accepted_now.covers("/camera", "/image", Kind::kDied));
    EXPECT_TRUE(accepted_now.covers("/camera", "/image", Kind::kSlow));
    EXPECT_FALSE(accepted_now.covers("/camera", "/info", Kind::kSlow));
  }
}

TEST(Acceptances, WhoMayBeAbsentIsJudgedWhileThere) {
  Acceptances accepted_now;
  accepted_now.add(accepted("/joy*", "", Kind::kNeverCame));
  EXPECT_TRUE(accepted_now.mayBeAbsent("/joystick", "/joy"));
  EXPECT_FALSE(accepted_now.mayBeAbsent("/camera", "/image"));
  for (const Kind kind : {Kind::kDied, Kind::kSlow, Kind::kStranger}) {
    EXPECT_FALSE(accepted_now.covers("/joystick", "/joy", kind)) << toString(kind);
  }
  Acceptances all;
  all.add(accepted("/joystick", ""));
  EXPECT_FALSE(all.mayBeAbsent("/joystick", "/joy")) << "it is not judged at all";
  all.add(accepted_now);
  EXPECT_TRUE(all.mayBeAbsent("/joystick", "/joy"));
}

TEST(Acceptances, EachIsThereOnceAndTakenBack) {
  Acceptances accepted_now;
  EXPECT_TRUE(accepted_now.add(accepted("/camera", "")));
  EXPECT_TRUE(accepted_now.add(accepted("/camera", "")));
  EXPECT_EQ(accepted_now.list().size(), 1U);
  EXPECT_TRUE(accepted_now.remove(accepted("/camera", "/image")).empty());
  EXPECT_EQ(accepted_now.remove(accepted("/camera", "")).size(), 1U);
  EXPECT_FALSE(accepted_now.covers("/camera", "/image", Kind::kDied));
}

TEST(Acceptances, AllThatFitsIsTakenBack) {
  Acceptances all;
  all.add(accepted("/camera", "/image", Kind::kSlow));
  all.add(accepted("/camera", "", Kind::kStale));
  all.add(accepted("/cam*", "/image"));
  all.add(accepted("", "/image", Kind::kSlow));
  Acceptances left = all;
  EXPECT_EQ(left.remove(accepted("/camera", "")).size(), 2U);
  EXPECT_EQ(left.list().size(), 2U) << "wider ones stay";
  left = all;
  EXPECT_EQ(left.remove(accepted("/cam*", "")).size(), 3U);
  left = all;
  EXPECT_EQ(left.remove(accepted("", "", Kind::kSlow)).size(), 2U);
  ASSERT_EQ(left.list().size(), 2U);
  EXPECT_EQ(left.list()[0].kind, Kind::kStale) << "in their order";
}

TEST(Acceptances, ThereIsAMost) {
  Acceptances accepted_now;
  for (std::size_t i = 0; i < Acceptances::kMost; ++i) {
    EXPECT_TRUE(accepted_now.add(accepted("/node" + std::to_string(i), "")));
  }
  EXPECT_FALSE(accepted_now.add(accepted("/one_more", "")));
  EXPECT_EQ(accepted_now.list().size(), Acceptances::kMost);
}

}  // namespace
}  // namespace self_awareness::core
