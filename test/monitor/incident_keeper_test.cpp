#include "monitor/incident_keeper.h"

#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <fstream>
#include <optional>
#include <string>

#include "ros/verdict/incidents_file.h"
#include "self_awareness/SelfAwareness.h"

namespace self_awareness {
namespace {

namespace fs = boost::filesystem;
constexpr std::int64_t kSecond = 1000000000;
constexpr std::int64_t kEnd = 1000 * kSecond;

class IncidentKeeperTest : public testing::Test {
 protected:
  IncidentKeeperTest() { fs::create_directory(folder_); }
  ~IncidentKeeperTest() override { fs::remove_all(folder_); }
  IncidentKeeperTest(const IncidentKeeperTest&) = delete;
  IncidentKeeperTest& operator=(const IncidentKeeperTest&) = delete;

  RecorderFolder folder() const { return {folder_.string(), "/robot/watch", 1, 1}; }
  static core::Alarm alarm(std::int64_t second, const std::string& culprit, bool over = true) {
    core::Alarm alarm;
    alarm.id = static_cast<std::uint64_t>(second * kSecond);
    alarm.level = core::Alarm::Level::kAlarm;
    alarm.begin = alarm.end = second * kSecond;
    alarm.over = over;
    alarm.culprit = culprit;
    return alarm;
  }
  static core::Alarm suspicion(std::int64_t second, const std::string& culprit) {
    core::Alarm suspicion = alarm(second, culprit);
    suspicion.level = core::Alarm::Level::kSuspicion;
    return suspicion;
  }
  /// The monitor ends.
  static void end(IncidentKeeper& keeper) {
    keeper.onTick({kEnd, 0, kEnd});
    keeper.finish();
  }
  void add(IncidentKeeper& keeper, const core::Alarm& alarm, const std::string& file) {
    keeper.add(alarm, graph_, file, "robot.model");
  }

  const fs::path folder_ = fs::temp_directory_path() / fs::unique_path();
  const std::string path_ = (folder_ / "robot_watch.incidents").string();
  core::SourceGraph graph_;
};

TEST_F(IncidentKeeperTest, AnIncidentHasTheFileOfItsFirstAlarm) {
  IncidentKeeper keeper(folder(), [](const Incidents& /*incidents*/) {});
  keeper.restore(std::nullopt);
  EXPECT_TRUE(keeper.incidents().incidents.empty());
  add(keeper, alarm(10, "/a"), "first.bag");
  add(keeper, alarm(20, "/b"), "second.bag");
  add(keeper, alarm(30, "/a"), "third.bag");
  end(keeper);
  const auto kept = ros1::readIncidents(path_);
  ASSERT_TRUE(kept);
  EXPECT_EQ(*kept, keeper.incidents());
  ASSERT_EQ(kept->incidents.size(), 2U);
  EXPECT_EQ(kept->incidents[0].recording, "first.bag");
  EXPECT_EQ(kept->incidents[0].alarms, 2U);
  EXPECT_EQ(kept->incidents[1].recording, "second.bag");
  EXPECT_EQ(kept->incidents[1].model, "robot.model");
}

TEST_F(IncidentKeeperTest, AnotherStartGoesOnWithThem) {
  {
    IncidentKeeper keeper(folder(), [](const Incidents& /*incidents*/) {});
    keeper.restore(std::nullopt);
    add(keeper, alarm(10, "/a"), "first.bag");
    add(keeper, alarm(20, "/b", false), "second.bag");
    end(keeper);
  }
  IncidentKeeper keeper(folder(), [](const Incidents& /*incidents*/) {});
  keeper.restore(20 * kSecond);
  EXPECT_FALSE(keeper.incidents().incidents[1].over) << "its alarm stands again";
  EXPECT_FALSE(keeper.incidents().incidents[1].unknown);
  add(keeper, alarm(20, "/b", false), "");
  add(keeper, alarm(40, "/a"), "third.bag");
  ASSERT_EQ(keeper.incidents().incidents.size(), 2U);
  EXPECT_EQ(keeper.incidents().incidents[0].recording, "first.bag");
  EXPECT_EQ(keeper.incidents().incidents[0].alarms, 2U);
  EXPECT_EQ(keeper.incidents().incidents[1].recording, "second.bag");
  EXPECT_TRUE(keeper.incidents().incidents[1].over);
  EXPECT_FALSE(keeper.incidents().incidents[1].unknown) << "another alarm has ended it";
}

TEST_F(IncidentKeeperTest, WhatIsOpenWhenTheMonitorEndsIsUnknownSince) {
  IncidentKeeper keeper(folder(), [](const Incidents& /*incidents*/) {});
  keeper.restore(std::nullopt);
  add(keeper, alarm(10, "/a"), "");
  add(keeper, alarm(20, "/b", false), "");
  end(keeper);
  const auto kept = ros1::readIncidents(path_).value().incidents;
  EXPECT_FALSE(kept.at(0).unknown) << "it was over";
  EXPECT_TRUE(kept.at(1).over);
  EXPECT_TRUE(kept.at(1).unknown);
  EXPECT_EQ(kept.at(1).ended.sec, 1000U);
}

TEST_F(IncidentKeeperTest, WhatWasOpenWhenTheMonitorWasKilledIsUnknownFromTheNextStartOn) {
  self_awareness::Incidents before;
  {
    IncidentKeeper keeper(folder(), [](const Incidents& /*incidents*/) {});
    keeper.restore(std::nullopt);
    add(keeper, alarm(20, "/b", false), "");
    before = keeper.incidents();
    end(keeper);
  }
  ros1::writeIncidents(before, path_);  // as it was: nobody had finished
  IncidentKeeper keeper(folder(), [](const Incidents& /*incidents*/) {});
  keeper.restore(std::nullopt);
  EXPECT_TRUE(keeper.incidents().incidents.at(0).over);
  EXPECT_TRUE(keeper.incidents().incidents.at(0).unknown);
  end(keeper);
  const auto kept = ros1::readIncidents(path_).value().incidents;
  EXPECT_TRUE(kept.at(0).unknown) << "the file says so, too";
  EXPECT_EQ(kept.at(0).ended.sec, 20U) << "known until then";
}

TEST_F(IncidentKeeperTest, NearMissesReachTheFileAtTheEndAtTheLatest) {
  IncidentKeeper keeper(folder(), [](const Incidents& /*incidents*/) {});
  keeper.restore(std::nullopt);
  const std::int64_t start = 100 * IncidentKeeper::kNearMissesEvery;
  add(keeper, suspicion(10, "/a"), "of_an_alarm_before.bag");
  EXPECT_EQ(keeper.incidents().incidents.at(0).level, SelfAwareness::WARN);
  EXPECT_EQ(keeper.incidents().incidents.at(0).recording, "");
  keeper.onTick({kEnd, start, 0});
  add(keeper, suspicion(20, "/b"), "");
  keeper.onTick({kEnd, start + IncidentKeeper::kNearMissesEvery - 1, 0});
  end(keeper);
  EXPECT_EQ(ros1::readIncidents(path_)->incidents.size(), 2U) << "it is there at the end";
}

TEST_F(IncidentKeeperTest, ADamagedFileIsIgnored) {
  std::ofstream(path_) << "damaged";
  IncidentKeeper keeper(folder(), [](const Incidents& /*incidents*/) {});
  keeper.restore(std::nullopt);
  EXPECT_TRUE(keeper.incidents().incidents.empty());
  add(keeper, alarm(10, "/a"), "");
  end(keeper);
  EXPECT_EQ(ros1::readIncidents(path_)->incidents.size(), 1U);
}

}  // namespace
}  // namespace self_awareness
