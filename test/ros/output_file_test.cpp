// Tests files that are written whole or not at all.

#include "self_awareness/ros/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/filesystem.hpp>
#include <csignal>
#include <set>
#include <string>

#include "../in_folder.h"
#include "../problem.h"

namespace self_awareness::ros1 {
namespace {

namespace fs = boost::filesystem;

class OutputFileTest : public InFolder {
 protected:
  /// Writes "new" to a file as a program does that ends well.
  void writeNew(const std::string& name) const {
    OutputFile file(path(name));
    writeFile(file.temporary(), "new");
    file.complete();
  }
};

mode_t modeOf(const std::string& path) {
  struct stat status {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0);
  return status.st_mode & 07777U;
}

TEST_F(OutputFileTest, TakesThePlaceOfTheFileAtTheEndAndNotBefore) {
  writeFile(path("a.csv"), "old");
  OutputFile file(path("a.csv"));
  EXPECT_EQ(fs::path(file.temporary()).extension(), ".csv");
  writeFile(file.temporary(), "new");
  EXPECT_EQ(readFile(path("a.csv")), "old");
  file.complete();
  EXPECT_EQ(readFile(path("a.csv")), "new");
  { writeFile(OutputFile(path("a.csv")).temporary(), "half"); }
  EXPECT_EQ(readFile(path("a.csv")), "new") << "it was not completed";
  EXPECT_EQ(names(), std::set<std::string>{"a.csv"});
}

TEST_F(OutputFileTest, TwoMayWriteTheSameFile) {
  OutputFile one(path("a"));
  OutputFile other(path("a"));
  writeFile(one.temporary(), "one");
  writeFile(other.temporary(), "other");
  one.complete();
  EXPECT_EQ(readFile(path("a")), "one");
  other.complete();
  EXPECT_EQ(readFile(path("a")), "other");
}

TEST_F(OutputFileTest, ALinkStaysOneAndItsTargetIsReplacedOrMade) {
  fs::create_directory(path("far"));
  writeFile(path("far/target"), "old");
  fs::create_hard_link(path("far/target"), path("other_name"));
  fs::create_symlink("far/target", path("link"));
  fs::create_symlink("link", path("link_to_link"));
  writeNew("link_to_link");
  EXPECT_TRUE(fs::is_symlink(path("link")) && fs::is_symlink(path("link_to_link")));
  EXPECT_EQ(readFile(path("far/target")), "new");
  EXPECT_EQ(readFile(path("other_name")), "old");
  fs::remove(path("far/target"));
  writeNew("link");
  EXPECT_EQ(readFile(path("far/target")), "new");
  fs::create_symlink("b", path("a"));
  fs::create_symlink("a", path("b"));
  EXPECT_THROW(OutputFile(path("a")), FileError) << "links in a circle";
}

TEST_F(OutputFileTest, APipeIsWrittenDirectlyAndStays) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  {
    OutputFile file(path("pipe"));
    EXPECT_EQ(file.temporary(), path("pipe"));
  }
  OutputFile(path("pipe")).complete();
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
  writeFile(path("a"), "old");
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
    EXPECT_TRUE(begins(problemOf<FileError>([&] { OutputFile file(name); }),
                       name + ": cannot be written ("));
  }
}

TEST_F(OutputFileTest, ALongNameCanBeWritten) {
  const std::string name = std::string(250, 'a') + ".csv";
  EXPECT_EQ(fs::path(OutputFile(path(name)).temporary()).extension(), ".csv");
  writeNew(name);
  EXPECT_EQ(readFile(path(name)), "new");
}

TEST_F(OutputFileTest, WhatKilledProgramsLeftIsRemovedAndNothingElse) {
  const pid_t killed = ::fork();
  if (killed == 0) {
    OutputFile file(path("a"));
    writeFile(file.temporary(), "half");
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(killed, &status, 0), killed);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_EQ(names().size(), 1U);
  writeFile(path(".part"), "of somebody else");
  OutputFile in_work(path("b"));
  writeFile(in_work.temporary(), "b");
  { OutputFile next(path("c")); }
  EXPECT_EQ(names(),
            (std::set<std::string>{".part", fs::path(in_work.temporary()).filename().string()}));
  in_work.complete();
  EXPECT_EQ(readFile(path("b")), "b");
}

TEST_F(OutputFileTest, AMissingFolderIsNamedWithTheWayOut) {
  checkFolder("run");  // in this folder
  checkFolder(path("run"));
  const std::string folder = path("no such");
  EXPECT_EQ(problemOf<FileError>([&] { checkFolder(folder + "/run"); }),
            "there is no folder " + folder + ": create it (mkdir -p '" + folder + "')");
  writeFile(path("file"), "a");
  EXPECT_THROW(checkFolder(path("file/run")), FileError);
}

TEST_F(OutputFileTest, AFullDiskIsToldWithTheRoomThatThereIs) {
  writeFile(path("a"), std::string(2000000, 'x'));
  EXPECT_TRUE(begins(writeProblem("/far/b", ENOSPC, path("a")),
                     "/far/b: cannot be written (No space left on device, there is room for "));
  EXPECT_EQ(writeProblem("/far/b", EACCES), "/far/b: cannot be written (Permission denied)");
}

}  // namespace
}  // namespace self_awareness::ros1
