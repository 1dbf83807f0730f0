#include "monitor/alarm_keeper.h"

#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <cstdint>
#include <string>

#include "ros/verdict/standing_alarm.h"

namespace self_awareness {
namespace {

namespace filesystem = boost::filesystem;

class AlarmKeeperTest : public testing::Test {
 protected:
  ~AlarmKeeperTest() override { filesystem::remove_all(path_); }

  /// A start of the monitor.
  struct Started : AlarmKeeper {
    Started(const filesystem::path& folder, const std::string& run_id, std::uint64_t model)
        : AlarmKeeper(RecorderFolder(folder.string(), "/watch", 1, 1), run_id) {
      setModel(model);
    }
  };
  Started keeper(const std::string& run_id = "run", std::uint64_t model = 3) const {
    return {path_, run_id, model};
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
    Started first = keeper();
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

TEST_F(AlarmKeeperTest, AnAlarmOfAnotherModelStandsNoMoreAlsoWithTheOldOne) {
  {
    Started first = keeper();
    first.keep(alarm(SelfAwareness::ERROR), 5, "");
    first.finish();
  }
  {
    Started other = keeper("run", 4);
    EXPECT_FALSE(other.read());
    other.keep(alarm(SelfAwareness::OK), 0, "");
    other.finish();
  }
  EXPECT_FALSE(keeper().read()) << "nobody watched for it meanwhile";
}

TEST_F(AlarmKeeperTest, AFileThatNamesNoModelIsOfAny) {
  self_awareness::StandingAlarm standing;  // as of format 1
  standing.run_id = "run";
  standing.alarm = alarm(SelfAwareness::ERROR);
  filesystem::create_directories(path_);
  ros1::writeStandingAlarm(standing, (path_ / "watch.alarm").string());
  EXPECT_TRUE(keeper().read());
}

TEST_F(AlarmKeeperTest, WhatStoodBeforeTheStartIsForgottenIfItDoesNotStandAgain) {
  {
    Started first = keeper();
    first.keep(alarm(SelfAwareness::ERROR), 5, "");
    first.finish();
  }
  {
    Started second = keeper();
    EXPECT_TRUE(second.read());
    second.keep(alarm(SelfAwareness::OK), 0, "");
    second.finish();
  }
  EXPECT_FALSE(keeper().read());
}

}  // namespace
}  // namespace self_awareness
