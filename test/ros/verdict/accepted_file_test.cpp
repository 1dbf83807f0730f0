#include "ros/verdict/accepted_file.h"

#include <gtest/gtest.h>

#include <string>

#include "one_message_case.h"
#include "ros/verdict/one_message_file.h"
#include "self_awareness/Acceptances.h"

namespace self_awareness::ros1 {
namespace {

class AcceptedFileTest : public OneMessageTest<core::Acceptances> {
 protected:
  AcceptedFileTest() : OneMessageTest(writeAccepted, readAccepted, "") {
    core::Acceptance acceptance;
    acceptance.component = "/rostopic";
    acceptance.topic = "/cmd_vel";
    acceptance.at = 1600000000000000001;
    acceptance.by = "/rqt";
    content_.add(acceptance);
    acceptance.kind = core::Kind::kSlow;
    acceptance.topic.clear();
    content_.add(acceptance);
    acceptance.component.clear();
    acceptance.kind = core::Kind::kNewMode;
    acceptance.together = {"/arm", "/laser", "/wheels"};
    content_.add(acceptance);
  }
  /// Why a file with such an entry is refused; empty: it is not.
  std::string errorOf(const self_awareness::Acceptance& entry, std::size_t entries = 1) const {
    self_awareness::Acceptances message;
    message.accepted.assign(entries, entry);
    writeOneMessage({kAcceptedFile, "/accepted", "", 1 << 20}, message, ros::TIME_MIN, path_);
    return error();
  }
};

TEST_F(AcceptedFileTest, IsReadAsItWasWritten) {
  EXPECT_FALSE(readAccepted(path_)) << "there is no file";
  written();
  const auto read = readAccepted(path_);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->list().size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(read->list()[i].isLike(content_.list()[i]));
    EXPECT_EQ(read->list()[i].at, content_.list()[i].at);
    EXPECT_EQ(read->list()[i].by, "/rqt");
  }
}

TEST_F(AcceptedFileTest, WhatCannotBeIsRefused) {
  self_awareness::Acceptance entry;
  EXPECT_TRUE(has(errorOf(entry), "(one names nobody)"));
  entry.component = "/a";
  EXPECT_EQ(errorOf(entry), "");
  EXPECT_TRUE(has(errorOf(entry, 1001), "(there are too many)"));
  entry.kind = "odd";
  EXPECT_TRUE(has(errorOf(entry), "(the kind of one is none)"));
  entry.kind = "new mode";
  EXPECT_TRUE(has(errorOf(entry), "(one names nobody)"));
  entry.together = {"/a", "/b"};
  EXPECT_TRUE(has(errorOf(entry), "(one is of a component and of a mode)"));
  entry.component.clear();
  EXPECT_EQ(errorOf(entry), "");
  entry.together = {"/b", "/a"};
  EXPECT_TRUE(has(errorOf(entry), "(the components of a mode are in no order)"));
  entry.together = {std::string(1001, 'a')};
  EXPECT_TRUE(has(errorOf(entry), "(a name is too long)"));
  entry.together.clear();
  entry.component = "/a";
  entry.kind.clear();
  entry.by = std::string(1001, 'a');
  EXPECT_TRUE(has(errorOf(entry), "(a name is too long)"));
}

}  // namespace
}  // namespace self_awareness::ros1
