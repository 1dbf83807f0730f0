#include "monitor/recorder_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <stdexcept>

#include "../in_folder.h"
#include "../problem.h"

namespace self_awareness {
namespace {

using Names = std::set<std::string>;

constexpr std::int64_t kWallTime = 1795324233123456789;  // 2026-11-22 05:10:33.123456789 UTC [ns]

class RecorderFolderTest : public InFolder {
 protected:
  /// @param files, bytes that the folder may hold
  RecorderFolder folder(std::size_t files = 1, std::uint64_t bytes = 1000000) const {
    return {path("far/recorder"), "/watch", files, bytes};
  }
  void write(const Names& files, std::size_t bytes = 1) const {
    for (const std::string& file : files) {
      writeFile(path("far/recorder/" + file), std::string(bytes, 'x'));
    }
  }
  Names files() const { return names("far/recorder"); }
  /// Of a file; the smaller its number, the older it is.
  static std::string bag(const std::string& cause, int number) {
    return cause + "_2026-11-22-05-10-33.00" + std::to_string(number) + ".bag";
  }
};

TEST_F(RecorderFolderTest, NamesTellCauseAndTimeAndKnowTheFoldersOfRosAndOfTheMonitor) {
  const auto fileIn = [](const std::string& folder, const std::string& cause,
                         const std::string& name) {
    return RecorderFolder(folder, name, 1, 1).pathOf(cause, kWallTime);
  };
  const std::string time = "_2026-11-22-05-10-33.123.bag";
  EXPECT_EQ(fileIn("/data", "alarm", "/watch"), "/data/alarm" + time);
  EXPECT_EQ(fileIn("/data", "shutdown", "/watch"), "/data/shutdown" + time);
  const std::string home = std::getenv("HOME");
  EXPECT_EQ(fileIn("~/logs", "alarm", "/watch"), home + "/logs/alarm" + time);
  const std::string of_ros = "$ROS_HOME/self_awareness/$NAME";
  const char* const before = std::getenv("ROS_HOME");
  const std::string ros_home = before != nullptr ? before : "";
  setenv("ROS_HOME", "/data/ros", 1);
  EXPECT_EQ(fileIn(of_ros, "dump", "/robot/watch"),
            "/data/ros/self_awareness/robot_watch/dump" + time);
  unsetenv("ROS_HOME");
  EXPECT_EQ(fileIn(of_ros, "dump", "/watch"), home + "/.ros/self_awareness/watch/dump" + time);
  if (before != nullptr) {
    setenv("ROS_HOME", ros_home.c_str(), 1);
  }
}

TEST_F(RecorderFolderTest, ANameIsGivenOnceInAFolderThatIsCreated) {
  folder().create();
  folder().create();
  write({"alarm_2026-11-22-05-10-33.123.bag"});
  EXPECT_EQ(folder().pathOf("alarm", kWallTime),
            path("far/recorder/alarm_2026-11-22-05-10-33.124.bag"));
  boost::filesystem::remove_all(path("far/recorder"));
  writeFile(path("far/recorder"), "a file in its place");
  EXPECT_TRUE(
      has(problemOf<std::runtime_error>([this] { folder().create(); }), path("far/recorder")));
}

TEST_F(RecorderFolderTest, TheOldestAreRemovedWhateverTheirCause) {
  folder().create();
  write({bag("dump", 1), bag("alarm", 2), bag("shutdown", 3), bag("alarm", 4), bag("dump", 5),
         "robot.model", "alarm_precious.bag"});
  folder(3).makeRoom("");
  EXPECT_EQ(files(), (Names{bag("shutdown", 3), bag("alarm", 4), bag("dump", 5), "robot.model",
                            "alarm_precious.bag"}));
  folder(2).makeRoom(path("far/recorder/" + bag("shutdown", 3)));
  EXPECT_EQ(files(),
            (Names{bag("shutdown", 3), bag("dump", 5), "robot.model", "alarm_precious.bag"}))
      << "that of an alarm that stands stays";
}

TEST_F(RecorderFolderTest, TheirSizeIsBoundedButTheNewestStays) {
  const RecorderFolder bounded = folder(100, 1000);
  bounded.create();
  write({bag("alarm", 1), bag("alarm", 2)}, 400);
  bounded.makeRoom("");
  EXPECT_EQ(files(), (Names{bag("alarm", 1), bag("alarm", 2)}));
  write({bag("alarm", 3)}, 400);
  bounded.makeRoom("");
  EXPECT_EQ(files(), (Names{bag("alarm", 2), bag("alarm", 3)}));
  write({bag("alarm", 4)}, 5000);
  bounded.makeRoom("");
  EXPECT_EQ(files(), (Names{bag("alarm", 4)}));
}

}  // namespace
}  // namespace self_awareness
