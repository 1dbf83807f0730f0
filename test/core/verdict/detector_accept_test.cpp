// What is accepted while something stands, or is known to be new.

#include <gtest/gtest.h>

#include "accepted.h"
#include "told_judge.h"

namespace self_awareness::core {
namespace {

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
