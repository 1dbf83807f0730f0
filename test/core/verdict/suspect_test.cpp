#include "self_awareness/core/verdict/suspect.h"

#include <gtest/gtest.h>

namespace self_awareness::core {
namespace {

TEST(Suspect, AStrangerIsToldByWhatCameOfIt) {
  const Reason here = strangerIn(3);
  EXPECT_EQ(here.kind, Kind::kStranger);
  EXPECT_EQ(here.unit, unit::kEvents);
  EXPECT_EQ(here.value, 3);
  EXPECT_EQ(here.usual, 0);
  EXPECT_EQ(here.words, "never seen in training, 3 in this window");
  const Reason before = strangerBefore(1.25);
  EXPECT_EQ(before.kind, Kind::kStranger);
  EXPECT_EQ(before.unit, unit::kSeconds);
  EXPECT_EQ(before.value, 1.25);
  EXPECT_EQ(before.words, "never seen in training, the last one 1.2 s ago");
}

TEST(Suspect, AKindIsFoundByItsName) {
  EXPECT_EQ(kindOf("silent"), Kind::kSilent);
  EXPECT_EQ(kindOf("all silent"), Kind::kAllSilent);
  EXPECT_EQ(kindOf("new mode"), Kind::kNewMode);
  EXPECT_EQ(kindOf("not subscribed"), Kind::kUnsubscribed);
  EXPECT_EQ(kindOf("none of them"), std::nullopt);
  EXPECT_TRUE(isMissing(Kind::kNeverCame));
  EXPECT_FALSE(isMissing(Kind::kFast));
}

}  // namespace
}  // namespace self_awareness::core
