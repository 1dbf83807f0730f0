#include "ros/verdict/incidents_file.h"

#include <gtest/gtest.h>

#include <string>

#include "one_message_case.h"
#include "ros/verdict/standing_alarm.h"
#include "self_awareness/SelfAwareness.h"

namespace self_awareness::ros1 {
namespace {

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

}  // namespace
}  // namespace self_awareness::ros1
