#include "monitor/alarm_keeper.h"

#include <gtest/gtest.h>

#include "../in_folder.h"
#include "ros/verdict/kept_files.h"

namespace self_awareness {
namespace {

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
