#include "self_awareness/core/evidence/watch/machine_stalls.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "../recordings.h"

namespace self_awareness::core::evidence {
namespace {

// A robot that is heard every 20 ms.
class MachineStallsTest : public testing::Test {
 protected:
  MachineStallsTest() { stalls_.add(now_); }
  void run(std::int64_t time) {
    for (const std::int64_t end = now_ + time; now_ < end;) {
      stall(20 * kMillisecond);
    }
  }
  void stall(std::int64_t length) { stalls_.add(now_ += length); }
  std::vector<std::int64_t> lengths() const {
    std::vector<std::int64_t> lengths;
    for (const MachineStall& stall : stalls_.find()) {
      lengths.push_back(stall.length);
    }
    return lengths;
  }
  std::int64_t now_ = kStart;
  MachineStalls stalls_{Tuning{}};
};

TEST_F(MachineStallsTest, ASeldomSilenceOfAllIsOne) {
  run(40 * kSecond);
  EXPECT_TRUE(stalls_.find().empty());
  stall(1200 * kMillisecond);
  const std::int64_t end = now_;
  run(40 * kSecond);
  ASSERT_EQ(lengths(), (std::vector<std::int64_t>{1200 * kMillisecond}));
  EXPECT_EQ(stalls_.find()[0].end, end);
}

TEST_F(MachineStallsTest, OneThatIsTooShortOrTooLongIsNone) {
  run(40 * kSecond);
  stall(50 * kMillisecond);
  run(40 * kSecond);
  stall(kRateSpan + 1);
  run(40 * kSecond);
  EXPECT_TRUE(stalls_.find().empty());
  stall(kRateSpan);
  EXPECT_EQ(lengths(), (std::vector<std::int64_t>{kRateSpan}));
}

TEST_F(MachineStallsTest, WhatComesMoreOftenThanOneIsForgivenIsUsual) {
  for (int k = 0; k < 12; ++k) {
    run(10 * kSecond);
    stall(400 * kMillisecond);
  }
  EXPECT_TRUE(stalls_.find().empty());
  run(40 * kSecond);
  stall(500 * kMillisecond);
  run(40 * kSecond);
  EXPECT_TRUE(stalls_.find().empty()) << "that much longer is usual, too";
  stall(501 * kMillisecond);
  EXPECT_EQ(lengths(), (std::vector<std::int64_t>{501 * kMillisecond}));
}

TEST_F(MachineStallsTest, OneSoonAfterAnotherIsNone) {
  run(300 * kSecond);
  stall(300 * kMillisecond);
  run(25 * kSecond);
  stall(400 * kMillisecond);
  run(10 * kSecond);
  stall(500 * kMillisecond);
  EXPECT_EQ(lengths(), (std::vector<std::int64_t>{300 * kMillisecond, 500 * kMillisecond}));
}

TEST_F(MachineStallsTest, WithoutEventsThereIsNone) {
  EXPECT_TRUE(MachineStalls(Tuning{}).find().empty());
  EXPECT_TRUE(stalls_.find().empty());
}

TEST_F(MachineStallsTest, TheTimeAcrossAStepOfTheClockIsNone) {
  for (const bool seen : {false, true}) {
    stalls_ = MachineStalls(Tuning{});
    now_ = 0;
    stalls_.add(now_);
    if (seen) {
      now_ = 57000000 * kSecond;  // the first /clock
    } else {
      now_ += 300 * kSecond;  // by the tuning, ten stalls are usual
      stalls_.restart();
    }
    stalls_.add(now_);
    for (int k = 0; k < 12; ++k) {
      run(10 * kSecond);
      stall(400 * kMillisecond);
    }
    EXPECT_TRUE(stalls_.find().empty()) << seen;
    run(40 * kSecond);
    stall(501 * kMillisecond);
    EXPECT_EQ(lengths(), (std::vector<std::int64_t>{501 * kMillisecond})) << seen;
  }
}

TEST_F(MachineStallsTest, AStepOfTheClockHidesNone) {
  run(40 * kSecond);
  stall(kSecond);
  run(40 * kSecond);
  now_ = kStart - 10 * kSecond;  // by its stamps, it lies before the one above
  stalls_.add(now_);
  run(40 * kSecond);
  stall(1200 * kMillisecond);
  EXPECT_EQ(lengths(), (std::vector<std::int64_t>{kSecond, 1200 * kMillisecond}));
}

TEST_F(MachineStallsTest, AStampThatIsOlderIsNone) {
  run(40 * kSecond);
  stalls_.add(now_ - 100 * kMillisecond);
  run(40 * kSecond);
  EXPECT_TRUE(stalls_.find().empty());
}

}  // namespace
}  // namespace self_awareness::core::evidence
