#include "monitor/not_heard.h"

#include <gtest/gtest.h>

namespace self_awareness {
namespace {

TEST(NotHeard, WhoMayBeAbsentIsNamedAsTheModelNamesHim) {
  ros1::EncodingRules rules;
  rules.renames = {{"/r[0-9]+/(.*)", "/\\1"}};
  const ros1::Encoder encoder(rules, [](const core::EventType&) { return core::EventId{0}; });
  std::vector<ros1::Unheard> unheard(3);
  unheard[0].node = "/r7/joystick";
  unheard[0].topic = "/r7/joy";
  unheard[1].node = "/r7/arm_1764000000000";
  unheard[1].topic = "/r7/gripper";
  unheard[2].node = "/r7/player";
  unheard[2].topic = "/r7/scan";
  core::Acceptances accepted;
  core::Acceptance one;
  one.kind = core::Kind::kNeverCame;
  for (const char* name : {"/joy*", "/arm"}) {
    one.component = name;
    accepted.add(one);
  }
  one.component.clear();
  one.topic = "/gripper";
  accepted.add(one);
  const std::vector<ros1::Unheard> left = withoutOptional(unheard, accepted, encoder);
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left[0].node, "/r7/player");
}

}  // namespace
}  // namespace self_awareness
