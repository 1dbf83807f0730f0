// What outlives the monitor: the alarm that stands, and incidents.

#include <gtest/gtest.h>

#include "../in_folder.h"
#include "../times.h"
#include "monitor/alarm_keeper.h"
#include "monitor/incident_keeper.h"
#include "ros/verdict/kept_files.h"
#include "self_awareness/SelfAwareness.h"

namespace self_awareness {
namespace {

constexpr std::int64_t kEnd = 1000 * kSecond;

class IncidentKeeperTest : public InFolder {
 protected:
  /// A start of the monitor.
  struct Started : IncidentKeeper {
    explicit Started(const std::string& folder, std::optional<std::int64_t> stands = {})
        : IncidentKeeper(RecorderFolder(folder, "/robot/watch", 1, 1), [](const Incidents&) {}) {
      restore(stands);
    }
    /// It ends.
    void end() {
      onTick({kEnd, 0, kEnd});
      finish();
    }
  };
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

  const std::string path_ = path("robot_watch.incidents");
  core::SourceGraph graph_;
};

TEST_F(IncidentKeeperTest, AnIncidentHasTheFileOfItsFirstAlarmAndAnotherStartGoesOnWithIt) {
  {
    Started keeper(folder_.string());
    EXPECT_TRUE(keeper.incidents().incidents.empty());
    add(keeper, alarm(10, "/a"), "first.bag");
    add(keeper, alarm(20, "/b", false), "second.bag");
    keeper.end();
    EXPECT_EQ(ros1::readIncidents(path_), keeper.incidents());
  }
  Started keeper(folder_.string(), 20 * kSecond);
  EXPECT_FALSE(keeper.incidents().incidents.at(1).over) << "its alarm stands again";
  EXPECT_FALSE(keeper.incidents().incidents.at(1).unknown);
  add(keeper, alarm(20, "/b", false), "");
  add(keeper, alarm(40, "/a"), "third.bag");
  const auto kept = keeper.incidents().incidents;
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].recording, "first.bag");
  EXPECT_EQ(kept[0].alarms, 2U);
  EXPECT_EQ(kept[1].recording, "second.bag");
  EXPECT_EQ(kept[1].model, "robot.model");
  EXPECT_TRUE(kept[1].over);
  EXPECT_FALSE(kept[1].unknown) << "another alarm has ended it";
}

TEST_F(IncidentKeeperTest, WhatWasOpenWhenTheMonitorEndedOrWasKilledIsUnknownSince) {
  self_awareness::Incidents before;
  {
    Started keeper(folder_.string());
    add(keeper, alarm(20, "/b", false), "");
    before = keeper.incidents();
    keeper.end();
  }
  const auto ended = ros1::readIncidents(path_).value().incidents.at(0);
  EXPECT_TRUE(ended.over && ended.unknown);
  EXPECT_EQ(ended.ended.sec, 1000U) << "known until the monitor ended";
  ros1::writeIncidents(before, path_);  // as it was: nobody had finished
  Started keeper(folder_.string());
  EXPECT_TRUE(keeper.incidents().incidents.at(0).over);
  EXPECT_TRUE(keeper.incidents().incidents.at(0).unknown);
  keeper.end();
  const auto kept = ros1::readIncidents(path_).value().incidents;
  EXPECT_TRUE(kept.at(0).unknown) << "the file says so, too";
  EXPECT_EQ(kept.at(0).ended.sec, 20U) << "known until then";
  writeFile(path_, "damaged");
  EXPECT_TRUE(Started(folder_.string()).incidents().incidents.empty()) << "it is ignored";
}

TEST_F(IncidentKeeperTest, NearMissesReachTheFileAtTheEndAtTheLatest) {
  Started keeper(folder_.string());
  const std::int64_t start = 100 * IncidentKeeper::kNearMissesEvery;
  add(keeper, suspicion(10, "/a"), "of_an_alarm_before.bag");
  EXPECT_EQ(keeper.incidents().incidents.at(0).level, SelfAwareness::WARN);
  EXPECT_EQ(keeper.incidents().incidents.at(0).recording, "");
  keeper.onTick({kEnd, start, 0});
  add(keeper, suspicion(20, "/b"), "");
  keeper.onTick({kEnd, start + IncidentKeeper::kNearMissesEvery - 1, 0});
  keeper.end();
  EXPECT_EQ(ros1::readIncidents(path_)->incidents.size(), 2U) << "it is there at the end";
}

class AlarmKeeperTest : public InFolder {
 protected:
  /// A start of the monitor.
  struct Started : AlarmKeeper {
    Started(const std::string& folder, const std::string& run_id, std::uint64_t model)
        : AlarmKeeper(RecorderFolder(folder, "/watch", 1, 1), run_id) {
      setModel(model);
    }
  };
  Started keeper(const std::string& run_id = "run", std::uint64_t model = 3) const {
    return {path("recorder"), run_id, model};
  }
  static SelfAwareness alarm(std::uint8_t level) {
    SelfAwareness alarm;
    alarm.header.stamp = ros::Time(1000);
    alarm.level = level;
    alarm.alarm = 7;
    alarm.kind = SelfAwareness::SILENT;
    alarm.component = "/camera";
    return alarm;
  }
  /// While a start of the monitor lasts, an alarm stands.
  void stood(const std::string& recording = "") const {
    Started first = keeper();
    EXPECT_FALSE(first.read());
    first.keep(alarm(SelfAwareness::ERROR), 5, recording);
    first.finish();
    EXPECT_EQ(first.error(), "");
  }
};

TEST_F(AlarmKeeperTest, WhatStoodIsReadByAnotherStartUnderTheSameRoscore) {
  stood("alarm.bag");
  ASSERT_TRUE(keeper().read());
  EXPECT_EQ(keeper().read()->alarm.component, "/camera");
  EXPECT_EQ(keeper().read()->recording, "alarm.bag");
  EXPECT_FALSE(keeper("another run").read());
}

TEST_F(AlarmKeeperTest, WhatDoesNotStandAgainOrIsOfAnotherModelIsForgotten) {
  for (const std::uint64_t model : {3, 4}) {
    stood();
    Started second = keeper("run", model);
    EXPECT_EQ(second.read().has_value(), model == 3);
    second.keep(alarm(SelfAwareness::OK), 0, "");
    second.finish();
    EXPECT_FALSE(keeper().read()) << "nobody watched for it meanwhile";
  }
}

TEST_F(AlarmKeeperTest, AFileThatNamesNoModelIsOfAny) {
  self_awareness::StandingAlarm standing;  // as of format 1
  standing.run_id = "run";
  standing.alarm = alarm(SelfAwareness::ERROR);
  boost::filesystem::create_directory(path("recorder"));
  ros1::writeStandingAlarm(standing, path("recorder/watch.alarm"));
  EXPECT_TRUE(keeper().read());
}

}  // namespace
}  // namespace self_awareness
