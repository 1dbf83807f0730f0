#include "monitor/diagnostics.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <algorithm>
#include <set>

#include "../problem.h"
#include "ros/verdict/status_round.h"
#include "ros/verdict/verdict_message.h"

namespace self_awareness::ros1 {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr std::size_t kBytes = 2000;  // a second

/// A robot of 300 topics, as the monitor tells of it.
CommunicationState largeRobot() {
  CommunicationState state;
  state.calibrated = state.started = true;
  state.last.message = "normal communication";
  state.model = "/home/robot/.ros/self_awareness.model";
  for (int node = 0; node < 100; ++node) {
    const std::string name = "/robot/some_node_" + std::to_string(node);
    HeardReport::Component& component = state.heard.components[name];
    component.last_heard = 0.04;
    component.rate = 61.3;
    for (const char* const topic : {"/image_raw", "/camera_info", "/status"}) {
      component.rates[name + topic] = 20.4;
      state.expected[name][name + topic] = 20;
    }
    state.shares[name] = 0.1234;
    core::evidence::Coverage coverage;
    coverage.component = name;
    coverage.death_found_after = 0.21;
    state.coverage.push_back(coverage);
  }
  return state;
}

/// The same, and all lists are full.
MonitorState fullLists() {
  MonitorState of_monitor;
  CommunicationState& state = of_monitor.communication;
  state = largeRobot();
  for (int i = 0; i < 100; ++i) {
    const std::string name = "/robot/some_node_" + std::to_string(i);
    state.strangers.push_back({name + "_of_somebody", "/robot/topic_of_somebody", 1});
    state.accepted.push_back(name + "_that_is_new on /robot/topic (stranger), by /rqt");
    state.unheard.insert({name, name + "/debug"});
    state.watched_less.push_back(name + " on " + name + "/status after " + name + " on " + name);
    if (i >= 70) {
      state.coverage[static_cast<std::size_t>(i)].death_found_after.reset();
    }
    of_monitor.mutes.push_back(name +
                               " until 2026-11-23 15:04:11 UTC, by /rqt_gui_py_node_123; 3 alarms "
                               "and 12 suspicions were muted");
  }
  of_monitor.recorder.emplace().files.last_written =
      "/home/robot/.ros/self_awareness/self_awareness/alarm_20261123.bag";
  return of_monitor;
}

/// An alarm of five suspects stands, whose words change all the time.
void raise(CommunicationState& state, int second) {
  state.last.level = DiagnosticStatus::ERROR;
  state.last.alarm = 1764000000123456789;
  state.last.kind = "silent";
  state.last.component = "/robot/some_node_0";
  state.last.evidence = "overdue, rate, deadlines";
  state.last.suspects.clear();
  for (int i = 0; i < 5; ++i) {
    self_awareness::Suspect suspect;
    suspect.source = suspect.component = "/robot/some_node_" + std::to_string(i);
    suspect.scope = suspect.source + "/image_raw";
    suspect.type = "sensor_msgs/Image";
    suspect.reason = "silent for " + std::to_string(second) +
                     ".31 s, usually at most 0.061 s; 0 in the last 2 s";
    state.last.suspects.push_back(suspect);
  }
  state.last.message = "abnormal communication (overdue, rate, deadlines), " +
                       describe(state.last.suspects.front()) + ", and 4 others";
}

struct Sent {
  double bytes_per_second = 0;
  double longest = 0;  // between two statuses of one name [s]
  std::size_t names = 0;
};

/// What a monitor says in ten minutes. @param alarm whether one stands
Sent sendFor600s(MonitorState of_monitor, bool alarm) {
  CommunicationState& state = of_monitor.communication;
  StatusRound round(kBytes);
  ListRound lists;
  std::size_t bytes = 0;
  std::map<std::string, int> last;  // when each was said
  Sent sent;
  for (int second = 0; second < 600; ++second) {
    if (alarm) {
      raise(state, second);
      of_monitor.unheard.assign(
          100, {"/robot/some_node", "/robot/some_node/image_raw", "does not answer", false});
    }
    for (CommunicationState::Stranger& stranger : state.strangers) {
      stranger.events = static_cast<std::uint64_t>(second);
    }
    const double elapsed = second == 0 ? 0 : 1;
    state.lists = lists.next(allLists(of_monitor), elapsed);
    DiagnosticStatuses statuses("/self_awareness", "none", 1);
    diagnostic_updater::DiagnosticStatusWrapper whole;
    tellCommunication(state, whole);
    statuses.add("communication", whole);
    diagnostic_updater::DiagnosticStatusWrapper monitor;
    tellMonitor(of_monitor, monitor);
    statuses.add("monitor", monitor);
    DiagnosticStatuses of_components("/self_awareness", "none", 1);
    addComponents(state, of_components);
    addChosen(of_components, round, elapsed, statuses);
    bytes += ros::serialization::serializationLength(statuses.message());
    for (const DiagnosticStatus& status : statuses.message().status) {
      const auto before = last.find(status.name);
      if (before != last.end()) {
        sent.longest = std::max<double>(sent.longest, second - before->second);
      }
      last[status.name] = second;
    }
  }
  for (const auto& [name, when] : last) {
    sent.longest = std::max<double>(sent.longest, 600 - when);
  }
  sent.names = last.size();
  sent.bytes_per_second = static_cast<double>(bytes) / 600;
  return sent;
}

std::vector<DiagnosticStatus> componentsOf(const CommunicationState& state) {
  DiagnosticStatuses statuses("/self_awareness", "none", 1);
  addComponents(state, statuses);
  return statuses.message().status;
}

TEST(StatusRound, ThreeHundredTopicsTakeLessThanTwoKilobytesASecond) {
  const Sent quiet = sendFor600s(fullLists(), false);
  EXPECT_LT(quiet.bytes_per_second, kBytes) << "all lists are full; the first one of all, too";
  EXPECT_EQ(quiet.names, 102U);
  EXPECT_LE(quiet.longest, 51) << "everybody has his turn";
  const Sent alarm = sendFor600s(fullLists(), true);
  EXPECT_LT(alarm.bytes_per_second, 1.85 * kBytes) << "docs/monitor.md says so";
  EXPECT_EQ(alarm.names, 102U);
  EXPECT_LE(alarm.longest, 51);
}

/// What a status says; empty: nothing.
std::string saidIn(const DiagnosticStatus& status, const std::string& key) {
  for (const diagnostic_msgs::KeyValue& pair : status.values) {
    if (pair.key == key) {
      return pair.value;
    }
  }
  return "";
}

/// What the status of the robot's first component says.
std::string saidOfFirst(const CommunicationState& state, const std::string& key) {
  return saidIn(componentsOf(state).front(), key);
}

TEST(DiagnosticStatus, SaysInPercentHowNearTheLimitItCame) {
  CommunicationState state = largeRobot();
  EXPECT_EQ(saidOfFirst(state, "share of limit"), "12 %");
  state.last.threshold = -1;
  const auto said = [&](const char* key) {
    diagnostic_updater::DiagnosticStatusWrapper status;
    tellCommunication(state, status);
    return saidIn(status, key);
  };
  for (const auto& [score, words] :
       std::map<double, std::string>{{-1.104, "110 %"}, {0, "0 %"}, {-95.16, "9516 %"}}) {
    state.last.score = score;
    EXPECT_EQ(said("share of limit"), words);
  }
  EXPECT_EQ(said("score") + said("threshold"), "");
  state.last.score = 0.25;
  state.last.threshold = 0.5;  // of the paper's detector
  EXPECT_EQ(said("score") + ", " + said("threshold"), "0.25, 0.5");
  EXPECT_EQ(said("share of limit"), "");
}

TEST(DiagnosticStatus, SaysThatNoAlarmCanComeOrThatTheModelIsOfAnotherRobot) {
  CommunicationState state = largeRobot();
  const auto told = [&] {
    diagnostic_updater::DiagnosticStatusWrapper status;
    tellCommunication(state, status);
    return std::to_string(status.level) + " " + status.message;
  };
  state.heard.known_types = state.heard.unknown_types = 1;
  EXPECT_EQ(told(), "0 normal communication");
  state.heard.unknown_types = 2;
  EXPECT_TRUE(begins(told(), "1 ") && has(told(),
                                          "the model knows 1 of the 3 event types that were "
                                          "heard: is it of this robot?"));
  state.heard = {};
  state.calibrated = false;
  EXPECT_EQ(told(), "1 normal communication") << "who relies on an alarm must know";
}

TEST(DiagnosticStatus, SaysHowSoonADeathIsFoundAlsoWhileItIsNeeded) {
  CommunicationState state = largeRobot();
  const auto found = [&] { return saidOfFirst(state, "death found after [s]"); };
  EXPECT_EQ(found(), "0.21");
  core::evidence::Coverage& coverage = state.coverage.front();
  coverage.death_found_after = 9.5;
  coverage.found_when_asked = 0.6;
  EXPECT_EQ(found(), "9.5, 0.6 while it is needed");
  coverage.death_found_after.reset();
  EXPECT_EQ(found(), "0.6 while it is needed");
  coverage.found_when_asked.reset();
  EXPECT_EQ(found(), "not watched");
  coverage.accepted = true;
  EXPECT_EQ(found(), "not watched: accepted");
  EXPECT_EQ(componentsOf(state).front().message, "heard; not watched: accepted");
}

TEST(DiagnosticStatus, SaysWhoIsNamedOrAbsentAndItsRates) {
  CommunicationState state = largeRobot();
  const std::string name = state.coverage.front().component;
  EXPECT_EQ(saidOfFirst(state, name + "/status"), "20.4 of 20 Hz");
  raise(state, 3);
  EXPECT_EQ(componentsOf(state).front().level, DiagnosticStatus::ERROR);
  EXPECT_TRUE(has(componentsOf(state).front().message, "/image_raw: silent for 3.31 s"));
  state.last.level = DiagnosticStatus::OK;
  state.optional = {name};
  state.heard.components.at(name).last_heard.reset();
  EXPECT_EQ(componentsOf(state).front().message, "optional (absent)");
}

TEST(DiagnosticStatus, SaysWithWhatLateAnswersAreFound) {
  CommunicationState state = largeRobot();
  EXPECT_EQ(saidOfFirst(state, "late answers"), "");
  state.coverage.front().more_starts = 2;
  EXPECT_EQ(saidOfFirst(state, "late answers"), "after 2 more starts");
  state.coverage.front().late_answers = 0.06;
  EXPECT_EQ(saidOfFirst(state, "late answers"), "from 60 ms");
}

TEST(StatusRound, WhatIsNotOkIsSaidEveryFiveSeconds) {
  StatusRound round(100);
  std::vector<DiagnosticStatus> all = componentsOf(largeRobot());
  for (const std::size_t suspect : {3U, 50U, 90U}) {
    all[suspect].level = DiagnosticStatus::WARN;
  }
  round.next(all, 500, 0);
  std::map<std::string, int> said;
  for (int second = 0; second < 30; ++second) {
    for (const DiagnosticStatus& status : round.next(all, 500, 1)) {
      ++said[status.name];
    }
  }
  for (const std::size_t suspect : {3U, 50U, 90U}) {
    EXPECT_GE(said[all[suspect].name], 5);
    EXPECT_LE(said[all[suspect].name], 8);
  }
}

TEST(StatusRound, WithoutBytesEverybodyIsSaidWithinFiftySeconds) {
  StatusRound round(100);
  const std::vector<DiagnosticStatus> all = componentsOf(largeRobot());
  round.next(all, 500, 0);
  std::set<std::string> said;
  for (int tenth = 0; tenth < 500; ++tenth) {
    for (const DiagnosticStatus& status : round.next(all, 500, 0.1)) {
      EXPECT_TRUE(said.insert(status.name).second) << "in turn";
    }
  }
  EXPECT_GE(said.size(), 99U);
  StatusRound small(kBytes);
  for (int second = 0; second < 10; ++second) {
    EXPECT_EQ(small.next({all[0], all[1], all[2]}, 500, 1).size(), 3U) << "each time";
  }
}

TEST(StatusLists, AreBoundedInBytesAndSayHowManyMoreThereAre) {
  const std::vector<std::string> many(70, std::string(90, 'a'));
  EXPECT_LE(listed(many).size(), 320U);
  EXPECT_NE(listed(many).find(" and 67 more"), std::string::npos);
  EXPECT_LE(listed({std::string(5000, 'a')}).size(), 320U);
  diagnostic_updater::DiagnosticStatusWrapper status;
  tellList("not watched", many, ListsAre::kCounted, status);
  tellList("few", {"/a", "/b"}, ListsAre::kCounted, status);
  tellList("none", {}, ListsAre::kTold, status);
  tellNumbered("mute", many, ListsAre::kCounted, status);
  ASSERT_EQ(status.values.size(), 4U);
  EXPECT_EQ(status.values[0].value, "70, listed every 20 s");
  EXPECT_EQ(status.values[1].value, "/a, /b");
  EXPECT_EQ(status.values[2].key, "mute 1");
  EXPECT_EQ(status.values[3].key + ": " + status.values[3].value, "further mute: 69");
}

TEST(StatusLists, AreToldWhenTheyChangeAndEveryTwentySeconds) {
  ListRound round;
  EXPECT_EQ(round.next("/a: 1", 0), ListsAre::kTold);
  for (int second = 1; second < 20; ++second) {
    EXPECT_EQ(round.next("/a: " + std::to_string(10 * second), 1), ListsAre::kCounted);
  }
  EXPECT_EQ(round.next("/a: 1.5", 1), ListsAre::kTold) << "20 s";
  EXPECT_EQ(round.next("/a: 1, /b: 7", 1), ListsAre::kTold) << "another one";
  EXPECT_EQ(round.next("/a: 1, /b: 8", 1), ListsAre::kCounted);
}

TEST(StatusRound, WhatChangesIsSaidAtOnce) {
  StatusRound round(kBytes);
  std::vector<DiagnosticStatus> all = componentsOf(largeRobot());
  EXPECT_EQ(round.next(all, 500, 0).size(), 100U) << "the first time";
  all[70].level = DiagnosticStatus::ERROR;
  std::vector<DiagnosticStatus> said = round.next(all, 500, 0.1);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0].name, all[70].name);
  all[70].message = "/scan: silent for 2.31 s";
  EXPECT_EQ(round.next(all, 500, 0.1).size(), 1U);
  all[70].message = "/scan: silent for 12 s";
  EXPECT_TRUE(round.next(all, 500, 0.1).empty()) << "numbers do not count";
  all[70].message = "/scan: late by 12 s";
  EXPECT_EQ(round.next(all, 500, 0.1).size(), 1U);
}

}  // namespace
}  // namespace self_awareness::ros1
