#include "core/evidence/presence/unsubscribed.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "../../verdict/accepted.h"
#include "../recordings.h"

namespace self_awareness::core::evidence {
namespace {

const std::vector<EventType> kRobot{
    {"/camera", "/image", "T"}, {"/faces", "/people", "T"}, {"/faces", "/faces/debug", "T"}};

Events robot(std::int64_t start, unsigned seed) {
  return atRandom(kRobot.size(), start, 20 * kSecond, 100 * kMillisecond, seed);
}

class UnsubscribedTest : public testing::Test {
 protected:
  /// Whether something is missing for too long at a time [s].
  bool at(int seconds) {
    unsubscribed_.closeWindow(seconds * kSecond);
    return unsubscribed_.any();
  }
  std::vector<std::string> words() const {
    std::vector<std::string> words;
    for (const Suspect& suspect : unsubscribed_.suspects()) {
      words.push_back(suspect.component + " " + suspect.reason.words);
    }
    return words;
  }

  Model model_{watch(countsOf({robot(0, 100)}, kRobot), countsOf({robot(kStart, 200)}, kRobot))};
  Unsubscribed unsubscribed_{model_};
};

TEST_F(UnsubscribedTest, WhoNeverSubscribesIsNamedOnceAStartHasHadItsTime) {
  unsubscribed_.set({{"/faces", "/image"}});
  EXPECT_FALSE(at(100));
  EXPECT_FALSE(at(160));
  EXPECT_TRUE(at(161));
  EXPECT_EQ(words(), std::vector<std::string>{
                         "/faces does not subscribe to /image, as it did in all 2 starts"});
  const Suspect& suspect = unsubscribed_.suspects().front();
  EXPECT_EQ(suspect.id, 1) << "an event type of the component";
  EXPECT_EQ(suspect.reason.kind, Kind::kUnsubscribed);
  EXPECT_FALSE(suspect.abnormal) << "who is silent comes before it";
  EXPECT_TRUE(at(1000)) << "as long as it lasts";
  unsubscribed_.set({{"/faces", "/a"}, {"/faces", "/b"}, {"/faces", "/c"}, {"/faces", "/image"}});
  at(1061);
  at(1122);
  EXPECT_EQ(words(),
            std::vector<std::string>{
                "/faces does not subscribe to /a, /b, /c and 1 more, as it did in all 2 starts"});
}

TEST_F(UnsubscribedTest, WhatComesBackInTimeIsNoNewsAndASetClockBeginsAnew) {
  for (int k = 0; k < 10; ++k) {
    unsubscribed_.set({{"/faces", "/image"}});
    EXPECT_FALSE(at(100 * k));
    EXPECT_FALSE(at(100 * k + 50));
    unsubscribed_.set({});
    EXPECT_FALSE(at(100 * k + 51));
  }
  unsubscribed_.set({{"/faces", "/image"}});
  EXPECT_FALSE(at(1000));
  EXPECT_TRUE(at(1061));
  unsubscribed_.restart();
  EXPECT_FALSE(unsubscribed_.any());
  EXPECT_FALSE(at(0));
  EXPECT_FALSE(at(60));
  EXPECT_TRUE(at(61));
}

TEST_F(UnsubscribedTest, AnotherOneThatIsMissingDoesNotBeginItAnew) {
  unsubscribed_.set({{"/faces", "/image"}});
  at(0);
  unsubscribed_.set({{"/faces", "/image"}, {"/camera", "/region"}});
  EXPECT_FALSE(at(59));
  EXPECT_TRUE(at(61));
  EXPECT_EQ(words().size(), 1U);
  EXPECT_TRUE(at(120));
  EXPECT_EQ(words().size(), 2U);
}

}  // namespace
}  // namespace self_awareness::core::evidence
