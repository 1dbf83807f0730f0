#include "monitor/recorder_folder.h"

#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <cstdlib>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>

namespace self_awareness {
namespace {

namespace filesystem = boost::filesystem;
using Cause = RecorderFolder::Cause;

constexpr std::int64_t kWallTime = 1795324233123456789;  // 2026-11-22 05:10:33.123456789 UTC [ns]

class RecorderFolderTest : public testing::Test {
 protected:
  ~RecorderFolderTest() override { filesystem::remove_all(path_); }

  void write(const std::string& name, std::size_t bytes) const {
    std::ofstream((path_ / name).string()) << std::string(bytes, 'x');
  }
  std::set<std::string> names() const {
    std::set<std::string> names;
    for (const auto& entry : filesystem::directory_iterator(path_)) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

  const filesystem::path path_ =
      filesystem::temp_directory_path() / filesystem::unique_path() / "recorder";
};

TEST_F(RecorderFolderTest, NamesTellCauseAndTime) {
  const RecorderFolder folder("/data", "/watch", 1, 1);
  EXPECT_EQ(folder.pathOf(Cause::kAlarm, kWallTime), "/data/alarm_2026-11-22-05-10-33.123.bag");
  EXPECT_EQ(folder.pathOf(Cause::kDump, kWallTime), "/data/dump_2026-11-22-05-10-33.123.bag");
  EXPECT_EQ(folder.pathOf(Cause::kShutdown, kWallTime),
            "/data/shutdown_2026-11-22-05-10-33.123.bag");
}

TEST_F(RecorderFolderTest, KnowsTheHomeFolder) {
  EXPECT_EQ(RecorderFolder("~/logs", "/watch", 1, 1).pathOf(Cause::kAlarm, kWallTime),
            std::string(std::getenv("HOME")) + "/logs/alarm_2026-11-22-05-10-33.123.bag");
}

TEST_F(RecorderFolderTest, KnowsTheFolderOfRosAndTheNameOfTheMonitor) {
  const auto pathWith = [](const std::string& name) {
    return RecorderFolder("$ROS_HOME/self_awareness/$NAME", name, 1, 1)
        .pathOf(Cause::kDump, kWallTime);
  };
  const char* const before = std::getenv("ROS_HOME");
  const std::string ros_home = before != nullptr ? before : "";
  setenv("ROS_HOME", "/data/ros", 1);
  EXPECT_EQ(pathWith("/robot/watch"),
            "/data/ros/self_awareness/robot_watch/dump_2026-11-22-05-10-33.123.bag");
  unsetenv("ROS_HOME");
  EXPECT_EQ(pathWith("/watch"), std::string(std::getenv("HOME")) +
                                    "/.ros/self_awareness/watch/dump_2026-11-22-05-10-33.123.bag");
  if (before != nullptr) {
    setenv("ROS_HOME", ros_home.c_str(), 1);
  }
}

TEST_F(RecorderFolderTest, TheFileOfTheAlarmHasTheNameOfTheMonitor) {
  EXPECT_EQ(RecorderFolder("/shared", "/robot/watch", 1, 1).pathOfStandingAlarm(),
            "/shared/robot_watch.alarm");
}

TEST_F(RecorderFolderTest, ANameIsGivenOnce) {
  const RecorderFolder folder(path_.string(), "/watch", 1, 1);
  folder.create();
  write("alarm_2026-11-22-05-10-33.123.bag", 1);
  EXPECT_EQ(folder.pathOf(Cause::kAlarm, kWallTime),
            (path_ / "alarm_2026-11-22-05-10-33.124.bag").string());
}

TEST_F(RecorderFolderTest, IsCreatedWithAllFoldersAboveIt) {
  const RecorderFolder folder(path_.string(), "/watch", 1, 1);
  folder.create();
  EXPECT_TRUE(filesystem::is_directory(path_));
  folder.create();
}

TEST_F(RecorderFolderTest, AFileInItsPlaceIsNamed) {
  filesystem::create_directories(path_.parent_path());
  std::ofstream(path_.string()) << "a file";
  const RecorderFolder folder(path_.string(), "/watch", 1, 1);
  try {
    folder.create();
    FAIL() << "it is no folder";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(path_.string()), std::string::npos) << error.what();
  }
}

TEST_F(RecorderFolderTest, TheOldestAreRemovedWhateverTheirCause) {
  const RecorderFolder folder(path_.string(), "/watch", 3, 1000000);
  folder.create();
  write("dump_2026-11-22-05-10-33.001.bag", 1);
  write("alarm_2026-11-22-05-10-33.002.bag", 1);
  write("shutdown_2026-11-22-05-10-33.003.bag", 1);
  write("alarm_2026-11-22-05-10-33.004.bag", 1);
  write("dump_2026-11-22-05-10-33.005.bag", 1);
  write("robot.model", 1);
  write("alarm_precious.bag", 1);
  folder.removeOldest("");
  EXPECT_EQ(names(),
            (std::set<std::string>{
                "shutdown_2026-11-22-05-10-33.003.bag", "alarm_2026-11-22-05-10-33.004.bag",
                "dump_2026-11-22-05-10-33.005.bag", "robot.model", "alarm_precious.bag"}));
}

TEST_F(RecorderFolderTest, TheFileOfAnAlarmThatStandsStays) {
  const RecorderFolder folder(path_.string(), "/watch", 2, 1000000);
  folder.create();
  for (const char* const name :
       {"alarm_2026-11-22-05-10-33.001.bag", "dump_2026-11-22-05-10-33.002.bag",
        "dump_2026-11-22-05-10-33.003.bag", "dump_2026-11-22-05-10-33.004.bag"}) {
    write(name, 1);
  }
  folder.removeOldest((path_ / "alarm_2026-11-22-05-10-33.001.bag").string());
  EXPECT_EQ(names(), (std::set<std::string>{"alarm_2026-11-22-05-10-33.001.bag",
                                            "dump_2026-11-22-05-10-33.004.bag"}));
}

TEST_F(RecorderFolderTest, TheirSizeIsBoundedButTheNewestStays) {
  const RecorderFolder folder(path_.string(), "/watch", 100, 1000);
  folder.create();
  write("alarm_2026-11-22-05-10-33.001.bag", 400);
  write("alarm_2026-11-22-05-10-33.002.bag", 400);
  folder.removeOldest("");
  EXPECT_EQ(names().size(), 2U);
  write("alarm_2026-11-22-05-10-33.003.bag", 400);
  folder.removeOldest("");
  EXPECT_EQ(names(), (std::set<std::string>{"alarm_2026-11-22-05-10-33.002.bag",
                                            "alarm_2026-11-22-05-10-33.003.bag"}));
  write("alarm_2026-11-22-05-10-33.004.bag", 5000);
  folder.removeOldest("");
  EXPECT_EQ(names(), (std::set<std::string>{"alarm_2026-11-22-05-10-33.004.bag"}));
}

}  // namespace
}  // namespace self_awareness
