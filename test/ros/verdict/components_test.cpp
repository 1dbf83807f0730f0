#include "ros/verdict/components.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "self_awareness/SelfAwareness.h"

namespace self_awareness::ros1 {
namespace {

using self_awareness::ComponentState;
using self_awareness::SelfAwareness;

class ComponentsTest : public testing::Test {
 protected:
  ComponentsTest() {
    state_.model = "robot.model";
    hear("/player", 0.02);
    hear("/slam", std::nullopt);
    state_.coverage.resize(2);
    state_.coverage[0].component = "/player";
    state_.coverage[0].gaps = 100;
    state_.coverage[0].death_found_after = 0.5;
    state_.coverage[1].component = "/slam";
    state_.coverage[1].gaps = 3;
    state_.expected["/player"] = {{"/scan", 25.0}, {"/odom", 10.0}};
    state_.shares["/player"] = 2.3;
    graph_.topics["/scan"] = {
        "sensor_msgs/LaserScan", {"/player"}, {"/slam", "/viewer", "/quiet"}};
    graph_.topics["/new"] = {"std_msgs/String", {"/stranger"}, {}};
    graph_.topics["/a"] = {"std_msgs/String", {}, {"/quiet"}};
    graph_.topics["/rosout"] = {"rosgraph_msgs/Log", {"/player", "/quiet"}, {}};
    graph_.topics["/monitor/status"] = {"self_awareness/SelfAwareness", {"/monitor"}, {}};
  }
  void hear(const std::string& name, std::optional<double> age) {
    HeardReport::Component& component = state_.heard.components[name];
    component.last_heard = age;
    if (age) {
      component.rates = {{"/scan", 24.0}, {"/odom", 10.0}};
    }
  }
  void suspect(const std::string& source, bool abnormal) {
    self_awareness::Suspect suspect;
    suspect.source = source;
    suspect.scope = "/topic";
    suspect.reason = "silent";
    suspect.abnormal = abnormal;
    state_.last.suspects.push_back(suspect);
  }
  std::map<std::string, ComponentState> components(const Graph* graph) {
    std::map<std::string, ComponentState> components;
    for (const ComponentState& each : toComponents(state_, graph, encoder_).components) {
      components[each.name] = each;
    }
    return components;
  }

  CommunicationState state_;
  Graph graph_;
  const Encoder encoder_{EncodingRules(), nullptr};
};

TEST_F(ComponentsTest, SaysHowEachOneIs) {
  const std::map<std::string, ComponentState> all = components(nullptr);
  ASSERT_EQ(all.size(), 2U);
  const ComponentState& player = all.at("/player");
  EXPECT_EQ(player.level, ComponentState::OK);
  EXPECT_EQ(player.state, "heard");
  EXPECT_DOUBLE_EQ(player.rate, 34);
  EXPECT_DOUBLE_EQ(player.usual_rate, 35);
  EXPECT_DOUBLE_EQ(player.age, 0.02);
  EXPECT_DOUBLE_EQ(player.share, 2.3);
  EXPECT_DOUBLE_EQ(player.found_after, 0.5);
  EXPECT_DOUBLE_EQ(player.found_when_asked, -1);
  EXPECT_EQ(player.not_watched, "");
  const ComponentState& slam = all.at("/slam");
  EXPECT_EQ(slam.state, "not heard yet");
  EXPECT_EQ(slam.age, -1);
  EXPECT_EQ(slam.share, -1);
  EXPECT_EQ(slam.usual_rate, 0);
  EXPECT_EQ(slam.not_watched, "too few messages in training: 3 gaps");
}

TEST_F(ComponentsTest, WhileAnAlarmStandsWhoIsWithinItsLimitsIsWell) {
  hear("/nav", 0.1);
  state_.last.level = SelfAwareness::ERROR;
  state_.last.component = "/slam";
  suspect("/player", true);
  suspect("/slam", false);
  suspect("/nav", false);
  std::map<std::string, ComponentState> all = components(nullptr);
  EXPECT_EQ(all["/slam"].level, ComponentState::ERROR);
  EXPECT_EQ(all["/slam"].state, "/topic: silent");
  EXPECT_EQ(all["/player"].level, ComponentState::WARN);
  EXPECT_EQ(all["/nav"].level, ComponentState::OK);
  state_.last.component = "/nav";
  state_.last.reason = "silent for 9 s";
  state_.last.suspects.pop_back();
  EXPECT_EQ(components(nullptr)["/nav"].level, ComponentState::OK) << "it has recovered";
  state_.last.suspects.clear();
  all = components(nullptr);
  EXPECT_EQ(all["/nav"].level, ComponentState::ERROR) << "it is not known";
  EXPECT_EQ(all["/nav"].state, "silent for 9 s");
  suspect("/player", true);
  state_.last.level = SelfAwareness::OK;
  EXPECT_EQ(components(nullptr)["/player"].level, ComponentState::OK);
}

TEST_F(ComponentsTest, NobodyOfTheGraphIsUnlisted) {
  const std::map<std::string, ComponentState> all = components(&graph_);
  ASSERT_EQ(all.size(), 5U) << "all but the node of this package";
  EXPECT_EQ(all.at("/stranger").not_watched, "training never heard it");
  EXPECT_EQ(all.at("/quiet").not_watched, "it publishes nothing that is listened to");
  EXPECT_EQ(all.at("/viewer").not_watched, "it publishes nothing");
  EXPECT_EQ(all.at("/viewer").age, -1);
  EXPECT_EQ(all.at("/player").not_watched, "");
  state_.strangers.push_back({"/stranger", "/new", 7});
  const self_awareness::Components message = toComponents(state_, nullptr, encoder_);
  EXPECT_EQ(message.model, "robot.model");
  ASSERT_EQ(message.strangers.size(), 1U);
  EXPECT_EQ(message.strangers[0].component, "/stranger");
  EXPECT_EQ(message.strangers[0].topic, "/new");
  EXPECT_EQ(message.strangers[0].kind, SelfAwareness::STRANGER) << "as ~accept takes them";
}

}  // namespace
}  // namespace self_awareness::ros1
