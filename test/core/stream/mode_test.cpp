#include "self_awareness/core/stream/mode.h"

#include <gtest/gtest.h>

#include "self_awareness/core/stream/vocabulary.h"

namespace self_awareness::core {
namespace {

constexpr EventId kDriving = 3;
constexpr EventId kDocked = 5;

TEST(ModeType, SaysItsModeAndNoFieldOfATypeIsOne) {
  const EventType type{"/logic", "/state", typeOfMode("std_msgs/String", "DRIVING [x]")};
  EXPECT_TRUE(tellsMode(type));
  EXPECT_EQ(modeOf(type), "DRIVING [x]");
  EXPECT_EQ(toString(type), "/logic /state std_msgs/String[mode: DRIVING [x]]");
  for (const char* other : {"std_msgs/String", "a/B[mode=DRIVING]", "a/B[x=[mode: DRIVING]]",
                            "a/B[mode: DRIVING", ""}) {
    EXPECT_FALSE(tellsMode({"/logic", "/state", other})) << other;
    EXPECT_EQ(modeOf({"/logic", "/state", other}), "") << other;
  }
  const Vocabulary vocabulary({{"/logic", "/state", "std_msgs/String"}, type});
  EXPECT_FALSE(vocabulary.tellsMode(0));
  EXPECT_TRUE(vocabulary.tellsMode(1));
  EXPECT_FALSE(vocabulary.tellsMode(2));
  EXPECT_TRUE(vocabulary.tellsMode(kOtherMode));
}

TEST(ModeTime, AModeLastsUntilAnotherOneIsTold) {
  ModeTime mode;
  EXPECT_EQ(mode.lasted(kDriving, 10), 0);
  mode.enter(kDriving, 100);
  mode.enter(kDriving, 150);
  EXPECT_EQ(mode.lasted(kDriving, 170), 70) << "told again, it is the same";
  mode.enter(kDocked, 200);
  EXPECT_EQ(mode.lasted(kDriving, 900), 100);
  EXPECT_EQ(mode.lasted(kDocked, 900), 700);
  mode.enter(kDriving, 1000);
  EXPECT_EQ(mode.lasted(kDriving, 1010), 110);
  mode.enter(std::nullopt, 1020);
  EXPECT_EQ(mode.lasted(kDriving, 5000), 120) << "one that is not known lasts then";
  EXPECT_FALSE(mode.mode());
}

TEST(ModeTime, LastsSinceItWasToldWithoutABreak) {
  ModeTime mode;
  EXPECT_FALSE(mode.lasting(100));
  mode.enter(kDriving, 100);
  mode.enter(kDocked, 200);
  mode.enter(kDriving, 300);
  mode.enter(kDriving, 340);
  EXPECT_EQ(mode.lasting(350)->id, kDriving);
  EXPECT_EQ(mode.lasting(350)->lasted, 50);
  EXPECT_EQ(mode.lasting(290)->lasted, 0);
  mode.restart();
  EXPECT_EQ(mode.lasting(400)->lasted, 0) << "no event of the recording has come";
  mode.enter(std::nullopt, 500);
  EXPECT_FALSE(mode.lasting(600));
}

TEST(ModeTime, ARestartForgetsTimeAndNotTheModeAndALateEventTurnsNothingBack) {
  ModeTime mode;
  mode.enter(kDriving, 100);
  EXPECT_EQ(mode.lasted(kDriving, 90), 0) << "late";
  mode.restart();
  EXPECT_EQ(mode.mode(), kDriving);
  EXPECT_EQ(mode.lasted(kDriving, 1000), 0);
  mode.begin(1000);
  mode.begin(2000);
  EXPECT_EQ(mode.lasted(kDriving, 2500), 1500) << "from the first event on";
  mode.enter(kDocked, 995);
  EXPECT_EQ(mode.lasted(kDriving, 3000), 0) << "late";
}

}  // namespace
}  // namespace self_awareness::core
