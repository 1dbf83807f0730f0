#include "self_awareness/core/verdict/acceptance.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "accepted.h"
#include "told_judge.h"

namespace self_awareness::core {
namespace {

TEST(Acceptances, WhatIsNamedMustAllFitAndWhoMayBeSilentMayDoAnything) {
  const Acceptances accepted_now = allOf({accepted("/rostopic*", "/cmd_vel", Kind::kStranger)});
  EXPECT_TRUE(accepted_now.covers("/rostopic_12", "/cmd_vel", Kind::kStranger));
  EXPECT_FALSE(accepted_now.covers("/rostopic_12", "/scan", Kind::kStranger));
  EXPECT_FALSE(accepted_now.covers("/joystick", "/cmd_vel", Kind::kStranger));
  EXPECT_FALSE(accepted_now.covers("/rostopic_12", "/cmd_vel", Kind::kSlow)) << "once known";
  for (const std::optional<Kind>& kind : {std::optional<Kind>(), {Kind::kSilent}}) {
    const Acceptances silent = allOf({accepted("", "/image", kind)});
    EXPECT_TRUE(silent.covers("/camera", "/image", Kind::kSilent));
    EXPECT_TRUE(silent.covers("/camera", "/image", Kind::kSlow));
    EXPECT_FALSE(silent.covers("/camera", "/info", Kind::kSlow));
  }
}

TEST(Acceptances, AModeCoversThatThoseOfItAreOffTogetherAndNoDeath) {
  Acceptances accepted_now = allOf({acceptedMode({"/arm", "/laser", "/lidar", "/wheels"})});
  EXPECT_TRUE(accepted_now.coversMode({"/arm", "/laser", "/lidar", "/wheels"}));
  EXPECT_TRUE(accepted_now.coversMode({"/arm", "/lidar"}));
  EXPECT_FALSE(accepted_now.coversMode({"/arm", "/imu"}));
  accepted_now.add(acceptedMode({"/imu"}));
  EXPECT_FALSE(accepted_now.coversMode({"/arm", "/imu"})) << "they are of two modes";
  EXPECT_FALSE(accepted_now.covers("/arm", "/joints", Kind::kSilent));
  EXPECT_FALSE(accepted_now.covers("/arm", "/joints", Kind::kSlow));
  EXPECT_FALSE(accepted_now.covers("", "", Kind::kAllSilent));
  EXPECT_TRUE(accepted_now.list().front().isAbout("/arm", "/joints"));
  EXPECT_FALSE(accepted_now.list().front().isAbout("/imu", "/imu/data"));
  EXPECT_FALSE(allOf({accepted("/arm")}).coversMode({"/arm"}));
}

TEST(Acceptances, AModeIsTakenBackByItselfItsKindOrOneOfIt) {
  const Acceptance arm = acceptedMode({"/arm", "/laser"});
  const Acceptance imu = acceptedMode({"/imu", "/lidar"});
  const auto left = [&](const Acceptance& pattern) {
    Acceptances accepted_now = allOf({arm, imu, arm /* replaces it */, accepted("/arm")});
    accepted_now.remove(pattern);
    return accepted_now.list().size();
  };
  EXPECT_EQ(left(arm), 2U);
  EXPECT_EQ(left(accepted("/arm", "")), 1U) << "what it does by itself, too";
  EXPECT_EQ(left(accepted("/i*", "")), 2U);
  EXPECT_EQ(left(accepted("", "", Kind::kNewMode)), 1U);
  EXPECT_EQ(left(accepted("/arm", "/joints")), 3U) << "a mode has no topic";
}

TEST(Acceptances, WhoMayBeAbsentIsJudgedWhileThere) {
  const Acceptances accepted_now = allOf({accepted("/joy*", "", Kind::kNeverCame)});
  EXPECT_TRUE(accepted_now.mayBeAbsent("/joystick", "/joy"));
  EXPECT_FALSE(accepted_now.mayBeAbsent("/camera", "/image"));
  for (const Kind kind : {Kind::kSilent, Kind::kSlow, Kind::kStranger}) {
    EXPECT_FALSE(accepted_now.covers("/joystick", "/joy", kind)) << toString(kind);
  }
  Acceptances all = allOf({accepted("/joystick")});
  EXPECT_FALSE(all.mayBeAbsent("/joystick", "/joy")) << "it is not judged at all";
  all.add(accepted_now);
  EXPECT_TRUE(all.mayBeAbsent("/joystick", "/joy"));
}

TEST(Acceptances, AllThatFitsIsTakenBackAndThereIsAMost) {
  const Acceptances all =
      allOf({accepted("/camera", "/image", Kind::kSlow), accepted("/camera", "", Kind::kStale),
             accepted("/cam*", "/image"), accepted("", "/image", Kind::kSlow)});
  Acceptances left = all;
  EXPECT_EQ(left.remove(accepted("/camera", "")).size(), 2U);
  EXPECT_EQ(left.list().size(), 2U) << "wider ones stay";
  left = all;
  EXPECT_EQ(left.remove(accepted("/cam*", "")).size(), 3U);
  left = all;
  EXPECT_EQ(left.remove(accepted("", "", Kind::kSlow)).size(), 2U);
  ASSERT_EQ(left.list().size(), 2U);
  EXPECT_EQ(left.list()[0].kind, Kind::kStale) << "in their order";
  Acceptances once;
  EXPECT_TRUE(once.add(accepted("/camera", "")));
  EXPECT_TRUE(once.add(accepted("/camera", "")));
  EXPECT_EQ(once.list().size(), 1U) << "each is there once";
  EXPECT_TRUE(once.remove(accepted("/camera", "/image")).empty());
  EXPECT_EQ(once.remove(accepted("/camera", "")).size(), 1U);
  EXPECT_FALSE(once.covers("/camera", "/image", Kind::kSilent));
  for (std::size_t i = 0; i < Acceptances::kMost; ++i) {
    EXPECT_TRUE(once.add(accepted("/node" + std::to_string(i))));
  }
  EXPECT_FALSE(once.add(accepted("/one_more")));
  EXPECT_EQ(once.list().size(), Acceptances::kMost);
}

class DetectorAcceptTest : public ToldTest {
 protected:
  static Acceptances ofUnknown(Kind kind) { return allOf({accepted("/7", "", kind)}); }
};

TEST_F(DetectorAcceptTest, WhoIsAcceptedIsNotNewAndToldOnceMoreAfterThatIsTakenBack) {
  start();
  EXPECT_TRUE(window(kUnknownId).suspicion);
  windows(30);
  EXPECT_FALSE(verdict_.suspicion) << "it was told once";
  EXPECT_EQ(detector_->unknown().size(), 1U);
  detector_->accept(ofUnknown(Kind::kStranger));
  EXPECT_TRUE(detector_->unknown().empty());
  EXPECT_FALSE(window(kUnknownId).suspicion);
  EXPECT_TRUE(detector_->unknown().empty());
  detector_->accept({});
  EXPECT_TRUE(window(kUnknownId).suspicion) << "told again";
  windows(30);
  EXPECT_FALSE(window(kUnknownId).suspicion) << "once";
}

TEST_F(DetectorAcceptTest, WhatIsAcceptedWhileItsWindowIsOpenIsNoNews) {
  for (const UnknownEvents unknown : {UnknownEvents::kWarn, UnknownEvents::kError}) {
    start(unknown);
    detector_->add({now_, kUnknownId});
    detector_->accept(ofUnknown(Kind::kStranger));
    EXPECT_FALSE(window().suspicion);
    EXPECT_FALSE(verdict_.alarm);
  }
}

TEST_F(DetectorAcceptTest, AResumedAlarmDoesNotWaitForWhoMayBeSilent) {
  Suspect dead = suspect("/7", kUnknownId);
  dead.reason.kind = Kind::kSilent;
  for (const bool before : {false, true}) {
    start();
    if (before) {
      detector_->accept(ofUnknown(Kind::kSilent));
    }
    detector_->resume({dead});
    if (!before) {
      windows(100);
      EXPECT_TRUE(verdict_.alarm) << "it is not heard";
      detector_->accept(allOf({accepted("/0", "", Kind::kSilent)}));
      windows(100);
      EXPECT_TRUE(verdict_.alarm) << "another one is accepted";
      detector_->accept(ofUnknown(Kind::kSilent));
    }
    windows(40);
    EXPECT_FALSE(verdict_.alarm) << before;
  }
}

}  // namespace
}  // namespace self_awareness::core
