#include "ros/verdict/kept_files.h"

#include <gtest/gtest.h>

#include <functional>

#include "../../in_folder.h"
#include "../../problem.h"
#include "self_awareness/Acceptances.h"
#include "self_awareness/SelfAwareness.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/bag_writer.h"
#include "self_awareness/ros/file_version.h"

namespace self_awareness::ros1 {
namespace {

using self_awareness::SelfAwareness;

/// A file of one message that a test writes, changes and reads again.
template <typename Content>
class OneMessageTest : public InFolder {
 protected:
  using Write = void (*)(const Content& content, const std::string& path);

  /// @param damaged what is said of a file whose content cannot be
  OneMessageTest(Write write, std::function<void(const std::string& path)> read,
                 std::string damaged)
      : write_(write), read_(std::move(read)), damaged_(std::move(damaged)) {}

  /// Writes the file. @return its bytes
  std::string written() const {
    write_(content_, path_);
    return readFile(path_);
  }
  /// Why the file that is there is refused; empty: it is not.
  std::string error() const {
    return problemOf<BagError>([this] { read_(path_); });
  }
  /// The same of a file with these bytes.
  std::string errorOf(const std::string& bytes) const {
    writeFile(path_, bytes);
    return error();
  }
  void expectRefused(const std::string& why, const std::function<void(Content&)>& change) {
    const Content before = content_;
    change(content_);
    EXPECT_EQ(errorOf(written()), path_ + ": " + damaged_ + " (" + why + ")");
    content_ = before;
  }

  const std::string path_ = path("one.bag");
  Content content_;

 private:
  Write write_;
  std::function<void(const std::string&)> read_;
  std::string damaged_;
};

class StandingAlarmTest : public OneMessageTest<self_awareness::StandingAlarm> {
 protected:
  StandingAlarmTest()
      : OneMessageTest(writeStandingAlarm, readStandingAlarm, "the alarm in it is damaged") {
    content_.run_id = "run";
    content_.recording = "/files/alarm.bag";
    SelfAwareness& alarm = content_.alarm;
    alarm.level = SelfAwareness::ERROR;
    alarm.alarm = 1600000000000000000;
    alarm.kind = "silent";
    alarm.component = "/driver";
    alarm.evidence = "overdue";
    self_awareness::Suspect suspect;
    suspect.source = suspect.component = "/driver";
    suspect.scope = "/scan";
    suspect.type = "T";
    suspect.kind = "silent";
    suspect.since.sec = 7;
    suspect.onset.sec = 5;
    suspect.unit = "s";
    suspect.usual = 0.1;
    alarm.suspects = {suspect};
  }
  void expectRefused(const std::string& why, const std::function<void(SelfAwareness&)>& change) {
    OneMessageTest::expectRefused(why, [&](auto& standing) { change(standing.alarm); });
  }
};

TEST_F(StandingAlarmTest, IsReadAsItWasWritten) {
  EXPECT_FALSE(readStandingAlarm(path_)) << "there is no file";
  written();
  const auto read = readStandingAlarm(path_);
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, content_);
  content_.alarm.level = SelfAwareness::OK;
  written();
  EXPECT_FALSE(readStandingAlarm(path_)) << "the alarm is over";
}

TEST_F(StandingAlarmTest, ADamagedFileIsRefusedByName) {
  const std::string good = written();
  ASSERT_EQ(errorOf(good), "");
  for (std::size_t place = 0; place < good.size(); place += 11) {
    EXPECT_TRUE(begins(errorOf(good.substr(0, place)), path_ + ": ")) << place;
    std::string bad = good;
    bad[place] = static_cast<char>(bad[place] ^ 0xff);
    errorOf(bad);  // whatever it is, it is said or read
  }
  EXPECT_TRUE(has(errorOf(good + std::string(2 << 20, 'x')), "it is no such file")) << "too large";
}

TEST_F(StandingAlarmTest, WhatCannotBeIsRefused) {
  expectRefused("its level is none", [](SelfAwareness& alarm) { alarm.level = 3; });
  expectRefused("its id is none", [](SelfAwareness& alarm) { alarm.alarm = 0; });
  expectRefused("its id is none", [](SelfAwareness& alarm) { alarm.alarm = ~0ULL; });
  expectRefused("its kind is none", [](SelfAwareness& alarm) { alarm.kind = "odd"; });
  expectRefused("the kind of a suspect is none",
                [](SelfAwareness& alarm) { alarm.suspects[0].kind = ""; });
  expectRefused("it has too many suspects", [](SelfAwareness& alarm) {
    alarm.suspects.resize(core::kMostSuspects + 1, alarm.suspects[0]);
  });
  content_.alarm.component = "/\x1b[2J";
  EXPECT_NE(errorOf(written()), "") << "its texts are printable";
}

TEST_F(StandingAlarmTest, SuspectsAreThoseThatTheModelKnows) {
  core::Vocabulary vocabulary({{"/other", "/odom", "T"}, {"/driver", "/scan", "T"}});
  self_awareness::Suspect unknown = content_.alarm.suspects[0];
  unknown.scope = "/elsewhere";
  content_.alarm.suspects.push_back(unknown);
  const auto suspects = fromMessages(content_.alarm.suspects, vocabulary);
  ASSERT_EQ(suspects.size(), 1U);
  EXPECT_EQ(suspects[0].id, 1U);
  EXPECT_EQ(suspects[0].component, "/driver");
  EXPECT_EQ(suspects[0].topic, "/scan");
  EXPECT_EQ(suspects[0].onset, 5000000000);
  EXPECT_EQ(suspects[0].since, 7000000000);
  EXPECT_EQ(suspects[0].reason.usual, 0.1);
  EXPECT_EQ(suspects[0].reason.kind, core::Kind::kSilent);
}

class IncidentsFileTest : public OneMessageTest<self_awareness::Incidents> {
 protected:
  IncidentsFileTest()
      : OneMessageTest(writeIncidents, readIncidents, "the incidents in it are damaged") {
    core::Incident incident;
    incident.id = incident.main = 1600000000000000000;
    incident.last = 1600000001000000000;
    incident.level = core::Alarm::Level::kAlarm;
    incident.kind = core::Kind::kSlow;
    incident.cause = "/driver";
    incident.reason = "too seldom";
    incident.together = {"/a"};
    incident.victims = {"/b"};
    incident.others = {"/c", "/d"};
    incident.opened = 1600000000000000000;
    incident.grown = incident.opened + 5;
    incident.end = incident.main_duration = incident.opened + 9;
    incident.main_duration = 9;
    incident.over = incident.unknown = true;
    incident.alarms = 7;
    incident.near_misses = 3;
    content_.incidents = {toMessage(incident)};
    content_.incidents[0].recording = "/files/alarm.bag";
    content_.incidents[0].model = "/files/robot.model";
  }
};

TEST_F(IncidentsFileTest, IsReadAsItWasWritten) {
  EXPECT_FALSE(readIncidents(path_)) << "there is no file";
  written();
  const auto read = readIncidents(path_);
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, content_);
  self_awareness::Incident message = content_.incidents[0];
  message.recording.clear();
  message.model.clear();
  EXPECT_EQ(toMessage(fromMessage(message)), message) << "the core has of it what it says";
}

TEST_F(IncidentsFileTest, WhatCannotBeIsRefused) {
  using self_awareness::Incidents;
  expectRefused("there are too many",
                [](Incidents& of) { of.incidents.resize(kMostIncidents + 1, of.incidents[0]); });
  expectRefused("the level of one is none", [](Incidents& of) { of.incidents[0].level = 0; });
  expectRefused("the id of one is none", [](Incidents& of) { of.incidents[0].id = 0; });
  expectRefused("the id of one is none", [](Incidents& of) { of.incidents[0].last = ~0ULL; });
  expectRefused("the kind of one is none", [](Incidents& of) { of.incidents[0].kind = "odd"; });
  expectRefused("it has too many components", [](Incidents& of) {
    of.incidents[0].victims.resize(core::Incident::kMostNamed + 1, "/a");
  });
  expectRefused("the name of a component is too long",
                [](Incidents& of) { of.incidents[0].others = {std::string(1001, 'a')}; });
  content_.incidents[0].component = "/\x1b[2J";
  EXPECT_NE(errorOf(written()), "") << "its texts are printable";
  writeStandingAlarm({}, path_);
  EXPECT_NE(error(), "") << "a file of another kind";
}

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
    BagWriter bag(path_);
    bag.write({kVersionTopic}, ros::TIME_MIN, versionOf(kAcceptedFile));
    bag.write({"/accepted"}, ros::TIME_MIN, message);
    bag.close();
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
