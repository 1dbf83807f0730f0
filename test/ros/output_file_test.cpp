// Tests files that are written whole or not at all.

#include "self_awareness/ros/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/filesystem.hpp>
#include <csignal>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace self_awareness::ros1 {
namespace {

namespace fs = boost::filesystem;

class OutputFileTest : public ::testing::Test {
 protected:
  OutputFileTest() { fs::create_directory(folder_); }
  ~OutputFileTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::set<std::string> names() const {
    std::set<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

  const fs::path folder_ = fs::temp_directory_path() / fs::unique_path("output_file_%%%%%%%%");
};

void put(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
}

std::string textOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

mode_t modeOf(const std::string& path) {
  struct stat status {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0);
  return status.st_mode & 07777U;
}

TEST_F(OutputFileTest, TakesThePlaceOfTheFileAtTheEndAndNotBefore) {
  put(path("a.csv"), "old");
  OutputFile file(path("a.csv"));
  EXPECT_EQ(fs::path(file.temporary()).extension(), ".csv");
  put(file.temporary(), "new");
  EXPECT_EQ(textOf(path("a.csv")), "old");
  file.complete();
  EXPECT_EQ(textOf(path("a.csv")), "new");
  EXPECT_EQ(names(), std::set<std::string>{"a.csv"});
}

TEST_F(OutputFileTest, LeavesNothingBehindWhereItIsNotCompleted) {
  put(path("a"), "old");
  {
    OutputFile file(path("a"));
    put(file.temporary(), "half");
  }
  EXPECT_EQ(textOf(path("a")), "old");
  EXPECT_EQ(names(), std::set<std::string>{"a"});
}

TEST_F(OutputFileTest, TwoMayWriteTheSameFile) {
  OutputFile one(path("a"));
  OutputFile other(path("a"));
  put(one.temporary(), "one");
  put(other.temporary(), "other");
  one.complete();
  EXPECT_EQ(textOf(path("a")), "one");
  other.complete();
  EXPECT_EQ(textOf(path("a")), "other");
}

TEST_F(OutputFileTest, ALinkStaysOneAndItsTargetIsReplaced) {
  fs::create_directory(path("far"));
  put(path("far/target"), "old");
  fs::create_symlink("far/target", path("link"));
  fs::create_symlink("link", path("link_to_link"));
  OutputFile file(path("link_to_link"));
  put(file.temporary(), "new");
  file.complete();
  EXPECT_TRUE(fs::is_symlink(path("link")) && fs::is_symlink(path("link_to_link")));
  EXPECT_EQ(textOf(path("far/target")), "new");
}

TEST_F(OutputFileTest, ALinkMayLeadToAFileThatIsNotThereYet) {
  fs::create_symlink("later", path("link"));
  OutputFile file(path("link"));
  put(file.temporary(), "new");
  file.complete();
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(textOf(path("later")), "new");
}

TEST_F(OutputFileTest, LinksInACircleAreAnError) {
  fs::create_symlink("b", path("a"));
  fs::create_symlink("a", path("b"));
  EXPECT_THROW(OutputFile(path("a")), FileError);
}

TEST_F(OutputFileTest, TheOtherNameOfAFileKeepsWhatItHad) {
  put(path("a"), "old");
  fs::create_hard_link(path("a"), path("b"));
  OutputFile file(path("a"));
  put(file.temporary(), "new");
  file.complete();
  EXPECT_EQ(textOf(path("a")), "new");
  EXPECT_EQ(textOf(path("b")), "old");
}

TEST_F(OutputFileTest, ADeviceIsWrittenDirectly) {
  OutputFile file("/dev/null");
  EXPECT_EQ(file.temporary(), "/dev/null");
  file.complete();
  file.close();
  EXPECT_EQ(fs::status("/dev/null").type(), fs::character_file);
}

TEST_F(OutputFileTest, APipeIsWrittenDirectlyAndStays) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  {
    OutputFile file(path("pipe"));
    EXPECT_EQ(file.temporary(), path("pipe"));
  }
  EXPECT_EQ(fs::status(path("pipe")).type(), fs::fifo_file);
}

TEST_F(OutputFileTest, AFileThatIsOpenAlreadyIsNamedByItself) {
  std::ofstream open(path("a"));
  const int file = ::open(path("a").c_str(), O_WRONLY);
  const std::string name = "/dev/fd/" + std::to_string(file);
  EXPECT_THROW(OutputFile out(name), FileError);
  ::close(file);
}

TEST_F(OutputFileTest, AFileKeepsItsPermissions) {
  put(path("a"), "old");
  fs::permissions(path("a"), fs::perms(0640));
  OutputFile file(path("a"));
  file.complete();
  EXPECT_EQ(modeOf(path("a")), 0640U);
  const mode_t mask = ::umask(0027);
  OutputFile(path("b")).complete();
  ::umask(mask);
  EXPECT_EQ(modeOf(path("b")), 0640U);
}

TEST_F(OutputFileTest, WhatCannotBeWrittenIsAnErrorThatNamesIt) {
  fs::create_directory(path("folder"));
  for (const std::string& name : {path("folder"), path("none/a"), path("folder/")}) {
    try {
      OutputFile file(name);
      FAIL() << name;
    } catch (const FileError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(name + ": cannot be written (", 0), 0U)
          << error.what();
    }
  }
}

TEST_F(OutputFileTest, ALongNameCanBeWritten) {
  const std::string name = path(std::string(250, 'a') + ".csv");
  OutputFile file(name);
  EXPECT_EQ(fs::path(file.temporary()).extension(), ".csv");
  put(file.temporary(), "new");
  file.complete();
  EXPECT_EQ(textOf(name), "new");
}

TEST_F(OutputFileTest, WhatKilledProgramsLeftIsRemovedAndNothingElse) {
  const pid_t killed = ::fork();
  if (killed == 0) {
    OutputFile file(path("a"));
    put(file.temporary(), "half");
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(killed, &status, 0), killed);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_EQ(names().size(), 1U);
  put(path(".part"), "of somebody else");
  OutputFile in_work(path("b"));
  put(in_work.temporary(), "b");
  { OutputFile next(path("c")); }
  EXPECT_EQ(names(),
            (std::set<std::string>{".part", fs::path(in_work.temporary()).filename().string()}));
  in_work.complete();
  EXPECT_EQ(textOf(path("b")), "b");
}

TEST_F(OutputFileTest, AMissingFolderIsNamedWithTheWayOut) {
  checkFolder("run");  // in this folder
  checkFolder(path("run"));
  try {
    checkFolder(path("no such/run"));
    FAIL();
  } catch (const FileError& error) {
    const std::string folder = path("no such");
    EXPECT_EQ(error.what(),
              "there is no folder " + folder + ": create it (mkdir -p '" + folder + "')");
  }
  put(path("file"), "a");
  EXPECT_THROW(checkFolder(path("file/run")), FileError);
}

TEST_F(OutputFileTest, AFullDiskIsToldWithTheRoomThatThereIs) {
  put(path("a"), std::string(2000000, 'x'));
  const std::string problem = writeProblem("/far/b", ENOSPC, path("a"));
  EXPECT_EQ(
      problem.rfind("/far/b: cannot be written (No space left on device, there is room for ", 0),
      0U)
      << problem;
  EXPECT_EQ(writeProblem("/far/b", EACCES), "/far/b: cannot be written (Permission denied)");
}

}  // namespace
}  // namespace self_awareness::ros1
