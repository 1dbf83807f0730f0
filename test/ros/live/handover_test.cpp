#include "ros/live/handover.h"

#include <gtest/gtest.h>

namespace self_awareness::ros1 {
namespace {

TEST(Handover, TheFirstSubscriptionCountsUntilAnotherIsReady) {
  Handover handover;
  EXPECT_TRUE(handover.complete());
  EXPECT_TRUE(handover.counts(0));
  EXPECT_FALSE(handover.counts(1)) << "it is not ready";
  handover.ready();
  EXPECT_FALSE(handover.complete()) << "no message has come";
  EXPECT_FALSE(handover.counts(0));
  EXPECT_TRUE(handover.counts(1));
  EXPECT_TRUE(handover.complete());
}

TEST(Handover, WhatComesToTheNewOneAloneDoesNotCount) {
  Handover handover;
  handover.ready();
  EXPECT_FALSE(handover.counts(1)) << "a latched message, again";
  EXPECT_FALSE(handover.counts(0));
  EXPECT_TRUE(handover.counts(1));
}

// Three subscriptions get four messages; the second and the third are ready at any moment.
TEST(Handover, EachMessageCountsOnceWheneverTheOthersAreReady) {
  constexpr int kSubscriptions = 3;
  constexpr int kMessages = 4;
  constexpr int kMoments = kSubscriptions * kMessages;
  for (int second = 0; second < kMoments; ++second) {
    for (int third = second; third < kMoments; ++third) {
      Handover handover;
      int moment = 0;
      for (int message = 0; message < kMessages; ++message) {
        int counted = 0;
        for (int number = 0; number < kSubscriptions; ++number, ++moment) {
          for (const int ready : {second, third}) {
            if (ready == moment) {
              handover.ready();
            }
          }
          counted += handover.counts(number) ? 1 : 0;
        }
        EXPECT_EQ(counted, 1) << "message " << message << ", ready at " << second << " and "
                              << third;
      }
    }
  }
}

}  // namespace
}  // namespace self_awareness::ros1
