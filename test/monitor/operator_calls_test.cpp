#include "monitor/operator_calls.h"

#include <gtest/gtest.h>

#include "../times.h"

namespace self_awareness {
namespace {

TEST(OperatorCalls, ALoopIsAnsweredSometimes) {
  OperatorCalls calls;
  int answered = 0;
  const std::int64_t start = 1000 * kSecond;
  for (std::int64_t now = start; now < start + 60 * kSecond; now += kSecond / 100) {
    answered += calls.admit("clear", "/loop", now) ? 1 : 0;
  }
  EXPECT_GE(answered, OperatorCalls::kAtOnce + 5);
  EXPECT_LE(answered, OperatorCalls::kAtOnce + 6);
  EXPECT_TRUE(calls.admit("reload", "/operator", start)) << "another service";
}

TEST(OperatorCalls, KeepsOnRecordWhoAndWhen) {
  OperatorCalls calls;
  EXPECT_EQ(calls.onRecord(), "");
  calls.record("clear", "/operator", 1795324233 * kSecond);
  EXPECT_EQ(calls.onRecord(), "~clear by /operator at 2026-11-22 05:10:33 UTC");
}

}  // namespace
}  // namespace self_awareness
