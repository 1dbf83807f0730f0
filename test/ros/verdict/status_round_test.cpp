#include "ros/verdict/status_round.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "ros/verdict/diagnostic_status.h"

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
    core::evidence::Coverage coverage;
    coverage.component = name;
    coverage.death_found_after = 0.21;
    state.coverage.push_back(coverage);
  }
  return state;
}

std::vector<DiagnosticStatus> componentsOf(const CommunicationState& state) {
  DiagnosticStatuses statuses("/self_awareness", "none", 1);
  addComponents(state, statuses);
  return statuses.message().status;
}

TEST(StatusRound, ThreeHundredTopicsTakeLessThanTwoKilobytesASecond) {
  StatusRound round(kBytes);
  const CommunicationState state = largeRobot();
  std::size_t bytes = 0;
  std::map<std::string, double> last;  // when each was said
  double longest = 0;
  const int seconds = 600;
  for (int second = 0; second < seconds; ++second) {
    DiagnosticStatuses statuses("/self_awareness", "none", 1);
    diagnostic_updater::DiagnosticStatusWrapper whole;
    tellCommunication(state, whole);
    statuses.add("communication", whole);
    DiagnosticStatuses of_components("/self_awareness", "none", 1);
    addComponents(state, of_components);
    addChosen(of_components, round, second == 0 ? 0 : 1, statuses);
    bytes += ros::serialization::serializationLength(statuses.message());
    for (const DiagnosticStatus& status : statuses.message().status) {
      if (last.count(status.name) > 0) {
        longest = std::max(longest, second - last[status.name]);
      }
      last[status.name] = second;
    }
  }
  EXPECT_LT(bytes, kBytes * static_cast<std::size_t>(seconds)) << "the first one of all, too";
  EXPECT_EQ(last.size(), 101U);
  EXPECT_LT(longest, 50) << "everybody has his turn";
  RecordProperty("bytes_per_second", static_cast<int>(bytes / seconds));
  RecordProperty("longest_between_two", static_cast<int>(longest));
}

TEST(StatusRound, WhatChangesIsSaidAtOnce) {
  StatusRound round(kBytes);
  std::vector<DiagnosticStatus> all = componentsOf(largeRobot());
  EXPECT_EQ(round.next(all, 500, 0).size(), 100U) << "the first time";
  all[70].level = DiagnosticStatus::ERROR;
  std::vector<DiagnosticStatus> said = round.next(all, 500, 0.1);
  ASSERT_EQ(said.size(), 2U) << "and the next in turn";
  EXPECT_EQ(said[0].name, all[70].name);
  all[70].message = "silent for 3 s";
  EXPECT_EQ(round.next(all, 500, 0.1)[0].name, all[70].name);
}

TEST(StatusRound, ASmallRobotIsSaidEachTime) {
  StatusRound round(kBytes);
  std::vector<DiagnosticStatus> all = componentsOf(largeRobot());
  all.resize(3);
  for (int second = 0; second < 10; ++second) {
    round.next(all, 500, 1);
  }
  EXPECT_EQ(round.next(all, 500, 1).size(), 3U);
}

}  // namespace
}  // namespace self_awareness::ros1
