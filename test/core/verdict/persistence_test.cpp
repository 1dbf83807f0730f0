#include "self_awareness/core/verdict/persistence.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>

namespace self_awareness::core {
namespace {

TEST(Persistence, RaisesAtKOfNAndClearsAfterTheHoldTime) {
  Persistence persistence({3, 5, 200});
  std::int64_t end = 0;
  const auto add = [&](bool abnormal) { return persistence.add(abnormal, end += 100); };
  for (const bool abnormal : {true, false, true, false, false}) {
    EXPECT_FALSE(add(abnormal));
  }
  EXPECT_FALSE(add(true));  // 2 of the last 5
  EXPECT_FALSE(add(false));
  EXPECT_FALSE(add(true));
  EXPECT_TRUE(add(true));  // 3 of 5
  EXPECT_TRUE(add(false));
  EXPECT_FALSE(add(false));
}

TEST(Persistence, HoldsWhileAbnormalWindowsKeepComing) {
  Persistence persistence({1, 1, 250});
  EXPECT_TRUE(persistence.add(true, 100));
  EXPECT_TRUE(persistence.add(false, 200));
  EXPECT_TRUE(persistence.add(true, 300));
  EXPECT_TRUE(persistence.add(false, 400));
  EXPECT_TRUE(persistence.add(false, 500));
  EXPECT_FALSE(persistence.add(false, 600));
}

TEST(Persistence, TheHoldTimeStandsStillInWindowsThatAreLeftOut) {
  Persistence persistence({1, 1, 250});
  EXPECT_FALSE(persistence.leaveOut(100));
  EXPECT_TRUE(persistence.add(true, 200));
  EXPECT_TRUE(persistence.leaveOut(100));
  EXPECT_TRUE(persistence.leaveOut(100));
  EXPECT_TRUE(persistence.leaveOut(100));
  EXPECT_TRUE(persistence.add(false, 600));
  EXPECT_TRUE(persistence.add(false, 700));
  EXPECT_FALSE(persistence.add(false, 800));
}

TEST(Persistence, RefusesImpossibleValues) {
  EXPECT_THROW(Persistence({0, 5, 0}), std::invalid_argument);
  EXPECT_THROW(Persistence({6, 5, 0}), std::invalid_argument);
  EXPECT_THROW(Persistence({1, 5, -1}), std::invalid_argument);
}

}  // namespace
}  // namespace self_awareness::core
