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
  void add(IncidentKeeper& keeper, const core::Alarm& alarm, const std::string& file) {
    keeper.add(alarm, graph_, file, "robot.model");
  }

  const fs::path folder_ = fs::temp_directory_path() / fs::unique_path();
  const std::string path_ = (folder_ / "robot_watch.incidents").string();
  core::SourceGraph graph_;
};

TEST_F(IncidentKeeperTest, AnIncidentHasTheFileOfItsFirstAlarm) {
  IncidentKeeper keeper(folder());
  keeper.restore(std::nullopt);
  EXPECT_TRUE(keeper.incidents().incidents.empty());
  add(keeper, alarm(10, "/a"), "first.bag");
  add(keeper, alarm(20, "/b"), "second.bag");
  add(keeper, alarm(30, "/a"), "third.bag");
  keeper.finish();
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
    IncidentKeeper keeper(folder());
    keeper.restore(std::nullopt);
    add(keeper, alarm(10, "/a"), "first.bag");
    add(keeper, alarm(20, "/b", false), "second.bag");
    keeper.finish();
  }
  IncidentKeeper gone(folder());
  gone.restore(std::nullopt);
  EXPECT_TRUE(gone.incidents().incidents[1].over) << "nothing stands";
  IncidentKeeper keeper(folder());
  keeper.restore(20 * kSecond);
  EXPECT_FALSE(keeper.incidents().incidents[1].over);
  add(keeper, alarm(20, "/b", false), "");
  add(keeper, alarm(40, "/a"), "third.bag");
  ASSERT_EQ(keeper.incidents().incidents.size(), 2U);
  EXPECT_EQ(keeper.incidents().incidents[0].recording, "first.bag");
  EXPECT_EQ(keeper.incidents().incidents[0].alarms, 2U);
  EXPECT_EQ(keeper.incidents().incidents[1].recording, "second.bag");
  EXPECT_TRUE(keeper.incidents().incidents[1].over);
}

TEST_F(IncidentKeeperTest, NearMissesReachTheFileAtTheEndAtTheLatest) {
  IncidentKeeper keeper(folder());
  keeper.restore(std::nullopt);
  const std::int64_t start = 100 * IncidentKeeper::kNearMissesEvery;
  add(keeper, suspicion(10, "/a"), "of_an_alarm_before.bag");
  EXPECT_EQ(keeper.incidents().incidents.at(0).level, SelfAwareness::WARN);
  EXPECT_EQ(keeper.incidents().incidents.at(0).recording, "");
  keeper.advance(start);
  add(keeper, suspicion(20, "/b"), "");
  keeper.advance(start + IncidentKeeper::kNearMissesEvery - 1);
  keeper.finish();
  EXPECT_EQ(ros1::readIncidents(path_)->incidents.size(), 2U) << "it is there at the end";
}

TEST_F(IncidentKeeperTest, ADamagedFileIsIgnored) {
  std::ofstream(path_) << "damaged";
  IncidentKeeper keeper(folder());
  keeper.restore(std::nullopt);
  EXPECT_TRUE(keeper.incidents().incidents.empty());
  add(keeper, alarm(10, "/a"), "");
  keeper.finish();
  EXPECT_EQ(ros1::readIncidents(path_)->incidents.size(), 1U);
}

}  // namespace
}  // namespace self_awareness
