#include "ros/verdict/accepted_file.h"

#include <gtest/gtest.h>

#include <string>

#include "kept_file_case.h"
#include "ros/verdict/incidents_file.h"
#include "ros/verdict/one_message_file.h"
#include "self_awareness/Acceptances.h"

namespace self_awareness::ros1 {
namespace {

class AcceptedFileTest : public KeptFileTest {
 protected:
  AcceptedFileTest() {
    core::Acceptance acceptance;
    acceptance.component = "/rostopic";
    acceptance.topic = "/cmd_vel";
    acceptance.at = 1600000000000000001;
    acceptance.by = "/rqt";
    accepted_.add(acceptance);
    acceptance.kind = core::Kind::kSlow;
    acceptance.topic.clear();
    accepted_.add(acceptance);
    acceptance.component.clear();
    acceptance.kind = core::Kind::kNewMode;
    acceptance.together = {"/arm", "/laser", "/wheels"};
    accepted_.add(acceptance);
  }
  void write() override { writeAccepted(accepted_, path_); }
  void read() override { readAccepted(path_); }
  /// Why a file with such entries is refused; empty: it is not.
  std::string errorOf(const self_awareness::Acceptance& entry, std::size_t entries = 1) {
    self_awareness::Acceptances message;
    message.accepted.assign(entries, entry);
    writeOneMessage({kAcceptedFile, "/accepted", "", 1 << 20}, message, ros::TIME_MIN, path_);
    try {
      read();
      return "";
    } catch (const BagError& error) {
      return error.what();
    }
  }

  core::Acceptances accepted_;
};

TEST_F(AcceptedFileTest, IsReadAsItWasWritten) {
  EXPECT_FALSE(readAccepted(path_)) << "there is no file";
  written();
  const auto read = readAccepted(path_);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->list().size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(read->list()[i].isLike(accepted_.list()[i]));
    EXPECT_EQ(read->list()[i].at, accepted_.list()[i].at);
    EXPECT_EQ(read->list()[i].by, "/rqt");
  }
}

TEST_F(AcceptedFileTest, ADamagedFileIsRefusedByName) {
  expectNoBeliefInDamage();
}

TEST_F(AcceptedFileTest, WhatCannotBeIsRefused) {
  self_awareness::Acceptance entry;
  EXPECT_NE(errorOf(entry).find("(one names nobody)"), std::string::npos);
  entry.component = "/a";
  EXPECT_EQ(errorOf(entry), "");
  EXPECT_NE(errorOf(entry, 1001).find("(there are too many)"), std::string::npos);
  entry.kind = "odd";
  EXPECT_NE(errorOf(entry).find("(the kind of one is none)"), std::string::npos);
  entry.kind = "new mode";
  EXPECT_NE(errorOf(entry).find("(one names nobody)"), std::string::npos);
  entry.together = {"/a", "/b"};
  EXPECT_NE(errorOf(entry).find("(one is of a component and of a mode)"), std::string::npos);
  entry.component.clear();
  EXPECT_EQ(errorOf(entry), "");
  entry.together = {"/b", "/a"};
  EXPECT_NE(errorOf(entry).find("(the components of a mode are in no order)"), std::string::npos);
  entry.together = {std::string(1001, 'a')};
  EXPECT_NE(errorOf(entry).find("(a name is too long)"), std::string::npos);
  entry.together.clear();
  entry.component = "/a";
  entry.kind.clear();
  entry.by = std::string(1001, 'a');
  EXPECT_NE(errorOf(entry).find("(a name is too long)"), std::string::npos);
}

TEST_F(AcceptedFileTest, AFileOfAnotherKindIsNone) {
  writeIncidents({}, path_);
  EXPECT_THROW(readAccepted(path_), BagError);
}

}  // namespace
}  // namespace self_awareness::ros1
