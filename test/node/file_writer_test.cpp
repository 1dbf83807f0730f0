#include "node/file_writer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <stdexcept>
#include <vector>

#include "../await.h"

namespace self_awareness {
namespace {

constexpr double kNever = 3600;  // [s]: the writer does not try again by itself

FileWriter::File fileOf(const std::string& path, std::function<void()> write) {
  return {path, 10, [write = std::move(write)](const std::string& /*path*/) { write(); }};
}

TEST(FileWriter, WritesInItsOwnThreadWithoutBeingWaitedFor) {
  FileWriter writer(kNever);
  std::promise<void> disk;
  std::thread::id thread;
  writer.add(fileOf("/a", [&, ready = disk.get_future().share()] {
    ready.wait();
    thread = std::this_thread::get_id();
  }));
  EXPECT_EQ(writer.report().waiting_bytes, 10U);
  EXPECT_EQ(writer.report().written, 0U);
  disk.set_value();
  ASSERT_TRUE(await([&] { return writer.report().written == 1; }));
  EXPECT_NE(thread, std::this_thread::get_id());
  EXPECT_EQ(writer.report().last_written, "/a");
  EXPECT_EQ(writer.report().waiting_bytes, 0U);
}

TEST(FileWriter, TriesAgainUntilTheDiskTakesIt) {
  FileWriter writer(1e-3);
  std::atomic<bool> full{true};
  std::atomic<int> attempts{0};
  writer.add(fileOf("/a", [&] {
    ++attempts;
    if (full) {
      throw std::runtime_error("/a: the disk is full");
    }
  }));
  ASSERT_TRUE(await([&] { return attempts > 2; }));
  EXPECT_EQ(writer.report().error, "/a: the disk is full");
  EXPECT_EQ(writer.report().waiting_bytes, 10U);
  full = false;
  ASSERT_TRUE(await([&] { return writer.report().written == 1; }));
  EXPECT_EQ(writer.report().error, "");
  EXPECT_EQ(writer.report().given_up, 0U);
}

TEST(FileWriter, AFewFilesWaitAndTheOldestIsGivenUp) {
  std::vector<std::string> written;
  {
    FileWriter writer(kNever);
    std::promise<void> busy;
    std::promise<void> disk;
    writer.add(fileOf("/0", [&, ready = disk.get_future().share()] {
      busy.set_value();
      ready.wait();
      written.push_back("/0");
    }));
    busy.get_future().wait();
    for (const char* path : {"/1", "/2", "/3"}) {
      writer.add(fileOf(path, [&written, path] { written.push_back(path); }));
    }
    EXPECT_EQ(writer.report().given_up, 1U);
    EXPECT_EQ(writer.report().waiting_bytes, 30U) << "one is being written, two wait";
    disk.set_value();
  }
  EXPECT_EQ(written, (std::vector<std::string>{"/0", "/2", "/3"}));
}

TEST(FileWriter, AtTheEndItTriesOnceMore) {
  int attempts = 0;
  {
    FileWriter writer(kNever);
    writer.add(fileOf("/a", [&] {
      ++attempts;
      throw std::runtime_error("/a: the disk is full");
    }));
    ASSERT_TRUE(await([&] { return !writer.report().error.empty(); }));
    EXPECT_EQ(writer.report().given_up, 0U);
  }
  EXPECT_EQ(attempts, 2);
}

}  // namespace
}  // namespace self_awareness
