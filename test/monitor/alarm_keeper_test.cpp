#include "monitor/alarm_keeper.h"

#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <string>

namespace self_awareness {
namespace {

namespace filesystem = boost::filesystem;

class AlarmKeeperTest : public testing::Test {
 protected:
  ~AlarmKeeperTest() override { filesystem::remove_all(path_); }

  /// As a start of the monitor.
  AlarmKeeper keeper(const std::string& run_id = "run") const {
    return {RecorderFolder(path_.string(), "/watch", 1, 1), run_id};
  }
  static SelfAwareness alarm(std::uint8_t level) {
    SelfAwareness alarm;
    alarm.header.stamp = ros::Time(1000);
    alarm.level = level;
    alarm.alarm = 7;
    alarm.kind = SelfAwareness::DIED;
    alarm.component = "/camera";
    return alarm;
  }

  const filesystem::path path_ =
      filesystem::temp_directory_path() / filesystem::unique_path() / "recorder";
};

TEST_F(AlarmKeeperTest, WhatStoodIsReadByAnotherStartUnderTheSameRoscore) {
  {
    AlarmKeeper first = keeper();
    EXPECT_FALSE(first.read());
    first.keep(alarm(SelfAwareness::ERROR), 5, "alarm.bag");
    first.finish();
    EXPECT_EQ(first.error(), "");
  }
  ASSERT_TRUE(keeper().read());
  EXPECT_EQ(keeper().read()->alarm.component, "/camera");
  EXPECT_EQ(keeper().read()->recording, "alarm.bag");
  EXPECT_FALSE(keeper("another run").read());
}

TEST_F(AlarmKeeperTest, WhatStoodBeforeTheStartIsForgottenIfItDoesNotStandAgain) {
  {
    AlarmKeeper first = keeper();
    first.keep(alarm(SelfAwareness::ERROR), 5, "");
    first.finish();
  }
  {
    AlarmKeeper second = keeper();
    EXPECT_TRUE(second.read());
    second.keep(alarm(SelfAwareness::OK), 0, "");
    second.finish();
  }
  EXPECT_FALSE(keeper().read());
}

}  // namespace
}  // namespace self_awareness
