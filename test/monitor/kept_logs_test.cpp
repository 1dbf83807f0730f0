#include "monitor/kept_logs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/filesystem.hpp>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "../await.h"
#include "self_awareness/core/stream/mode.h"
#include "self_awareness/ros/bag/event_log_reader.h"

namespace self_awareness {
namespace {

namespace filesystem = boost::filesystem;

constexpr std::int64_t kSecond = core::kNanosecondsPerSecond;
constexpr std::int64_t kStart = 1600000000 * kSecond;
constexpr std::int64_t kRobotStart = kStart - 60 * kSecond;
constexpr std::int64_t kStretch = KeptLogs::kLongest / kSecond;  // [s]

class KeptLogsTest : public testing::Test {
 protected:
  KeptLogsTest() {
    filesystem::create_directories(folder_);
    parameters_.on = true;
    vocabulary_.intern({"/player", "/scan", "T"});
    vocabulary_.intern({"/slam", "/pose", "T"});
    source_.encoding = ros1::EncodingRules::defaults();
  }
  ~KeptLogsTest() override {
    logs_.reset();  // it may still write
    filesystem::remove_all(folder_);
  }

  KeptLogs& logs() {
    if (!logs_) {
      logs_ = std::make_unique<KeptLogs>(
          parameters_, [this] { return source_; }, kRobotStart);
      logs_->setModel(model_, true);
    }
    return *logs_;
  }
  /// An event each second, one type after the other, from `from` to before `to` [s].
  void hear(std::int64_t from, std::int64_t to) {
    for (std::int64_t i = from; i < to; ++i) {
      logs().onEvent({kStart + i * kSecond, static_cast<core::EventId>(i & 1)}, vocabulary_);
      logs().onTick({0, 0, kStart + i * kSecond});
    }
  }
  bool awaitFiles(std::uint64_t number) {
    return await([&] { return logs().report().files.written == number; });
  }
  std::vector<std::string> files() const {
    std::vector<std::string> found;
    if (filesystem::exists(kept_)) {
      for (const auto& entry : filesystem::directory_iterator(kept_)) {
        found.push_back(entry.path().string());
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  const filesystem::path folder_ = filesystem::temp_directory_path() / filesystem::unique_path();
  const std::string model_ = (folder_ / "robot.model").string();
  const std::string kept_ = model_ + ".kept";
  KeptLogsParameters parameters_;
  ros1::LogSource source_;
  core::Vocabulary vocabulary_;
  std::unique_ptr<KeptLogs> logs_;
};

TEST_F(KeptLogsTest, AStretchIsKeptWhole) {
  hear(0, kStretch);
  EXPECT_EQ(logs().report().kept, 0U) << "it is not over";
  hear(kStretch, kStretch + 1);
  ASSERT_TRUE(awaitFiles(1));
  ASSERT_EQ(files().size(), 1U);
  const ros1::EventLogReader reader(files().front(), 0);
  EXPECT_EQ(reader.summary().start, kStart);
  EXPECT_EQ(reader.summary().robot_start, kRobotStart);
  std::size_t events = 0;
  reader.read(
      source_.encoding, [&](const core::EventType& type) { return *vocabulary_.find(type); }, {},
      [&](const core::Event& event) {
        EXPECT_EQ(event.stamp, kStart + static_cast<std::int64_t>(events) * kSecond);
        EXPECT_EQ(event.id, events & 1);
        ++events;
      });
  EXPECT_EQ(events, static_cast<std::size_t>(kStretch) + 1);
}

TEST_F(KeptLogsTest, EachStretchBeginsWithTheModeThatLasts) {
  const core::EventId mode =
      vocabulary_.intern({"/logic", "/state", core::typeOfMode("T", "DRIVING")});
  logs().onEvent({kStart, mode}, vocabulary_);
  hear(0, 2 * kStretch + 2);
  ASSERT_TRUE(awaitFiles(2));
  for (const std::string& file : files()) {
    std::vector<core::EventId> ids;
    ros1::EventLogReader(file, 0).read(
        source_.encoding, [&](const core::EventType& type) { return *vocabulary_.find(type); }, {},
        [&](const core::Event& event) { ids.push_back(event.id); });
    EXPECT_EQ(ids.front(), mode) << file;
    EXPECT_EQ(std::count(ids.begin(), ids.end(), mode), 1) << file;
  }
  // Another model has other ids.
  logs().setModel(model_, true);
  logs().onCut(Cut::kClockSet);
  hear(2 * kStretch + 10, 2 * kStretch + 30);
  logs().finish();
  EXPECT_EQ(files().size(), 3U);
  ros1::EventLogReader(files().back(), 0)
      .read(
          source_.encoding, [&](const core::EventType& type) { return *vocabulary_.find(type); },
          {}, [&](const core::Event& event) { EXPECT_NE(event.id, mode); });
}

TEST_F(KeptLogsTest, WhatIsNotNormalIsNotKeptAndTheNextStretchIs) {
  hear(0, 60);
  logs().leaveOut("an alarm");
  logs().leaveOut("a suspicion");
  hear(60, kStretch + 1);
  EXPECT_EQ(logs().report().left_out, 1U);
  EXPECT_EQ(logs().report().why, "an alarm");
  hear(kStretch + 1, 2 * kStretch + 2);
  ASSERT_TRUE(awaitFiles(1));
  ASSERT_EQ(files().size(), 1U);
  EXPECT_EQ(ros1::EventLogReader(files().front(), 0).summary().start,
            kStart + (kStretch + 1) * kSecond);
}

TEST_F(KeptLogsTest, TheLastStretchIsKeptUnlessItIsTooShort) {
  hear(0, 11);
  logs().finish();
  EXPECT_EQ(files().size(), 1U);
  logs_.reset();
  hear(0, 10);
  logs().finish();
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(KeptLogsTest, WhatIsLeftOutAtTheEndIsNotKept) {
  hear(0, 60);
  logs().leaveOut("an alarm");
  logs().finish();
  hear(60, 61);  // a last event may still come
  EXPECT_TRUE(files().empty());
}

TEST_F(KeptLogsTest, TheOldestMakeRoom) {
  parameters_.disk = 1;
  filesystem::create_directories(kept_);
  const auto fill = [this](const std::string& name) {
    std::ofstream((kept_ + "/" + name).c_str()) << std::string(600000, 'x');
  };
  fill("normal_2020-01-01-00-00-00.000.bag");
  fill("normal_2020-01-02-00-00-00.000.bag");
  fill("of_somebody_else.bag");
  hear(0, 60);
  logs().finish();
  ASSERT_EQ(files().size(), 3U);
  EXPECT_EQ(files()[0], kept_ + "/normal_2020-01-02-00-00-00.000.bag");
  EXPECT_EQ(files()[2], kept_ + "/of_somebody_else.bag");
}

TEST_F(KeptLogsTest, NothingIsKeptWithoutLimitsOrUnlessAsked) {
  logs().setModel(model_, false);
  hear(0, 60);
  logs().finish();
  EXPECT_TRUE(files().empty());
  logs_.reset();
  parameters_.on = false;
  hear(0, 60);
  logs().finish();
  EXPECT_TRUE(files().empty());
}

TEST_F(KeptLogsTest, AnotherStartOfTheRobotIsAnotherRecording) {
  hear(0, 60);
  logs().onRobotStart(kStart + 60 * kSecond);
  hear(60, 120);
  logs().finish();
  ASSERT_EQ(files().size(), 2U);
  EXPECT_EQ(ros1::EventLogReader(files()[0], 0).summary().robot_start, kRobotStart);
  EXPECT_EQ(ros1::EventLogReader(files()[1], 0).summary().robot_start, kStart + 60 * kSecond);
}

TEST_F(KeptLogsTest, AFolderThatCannotBeMadeIsTold) {
  std::ofstream(kept_.c_str()) << "a file";
  hear(0, kStretch + 1);
  ASSERT_TRUE(await([&] { return !logs().report().files.error.empty(); }));
  EXPECT_NE(logs().report().files.error.find(kept_), std::string::npos);
}

}  // namespace
}  // namespace self_awareness
