#include "monitor/kept_logs.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "../await.h"
#include "../in_folder.h"
#include "../times.h"
#include "self_awareness/core/stream/mode.h"
#include "self_awareness/ros/bag/event_log_reader.h"

namespace self_awareness {
namespace {

constexpr std::int64_t kRobotStart = kStart - 60 * kSecond;
constexpr std::int64_t kStretch = KeptLogs::kLongest / kSecond;  // [s]

class KeptLogsTest : public InFolder {
 protected:
  KeptLogsTest() {
    parameters_.on = true;
    vocabulary_.intern({"/player", "/scan", "T"});
    vocabulary_.intern({"/slam", "/pose", "T"});
    source_.encoding = ros1::EncodingRules::defaults();
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
  /// The files that are kept, the oldest first.
  std::vector<std::string> files() const {
    std::vector<std::string> found;
    if (boost::filesystem::exists(kept_)) {
      for (const std::string& name : names("robot.model.kept")) {
        found.push_back(kept_ + "/" + name);
      }
    }
    return found;
  }
  std::vector<core::Event> read(const std::string& file) const {
    std::vector<core::Event> events;
    ros1::EventLogReader(file, 0).read(
        source_.encoding, [&](const core::EventType& type) { return *vocabulary_.find(type); }, {},
        [&](const core::Event& event) { events.push_back(event); });
    return events;
  }
  /// The stamp that a file has of the start of the robot.
  static std::int64_t robotStart(const std::string& file) {
    return ros1::EventLogReader(file, 0).summary().robot_start;
  }

  const std::string model_ = path("robot.model");
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
  EXPECT_EQ(ros1::EventLogReader(files().front(), 0).summary().start, kStart);
  EXPECT_EQ(robotStart(files().front()), kRobotStart);
  const std::vector<core::Event> events = read(files().front());
  ASSERT_EQ(events.size(), static_cast<std::size_t>(kStretch) + 1);
  for (std::size_t k = 0; k < events.size(); ++k) {
    EXPECT_EQ(events[k].stamp, kStart + static_cast<std::int64_t>(k) * kSecond);
    EXPECT_EQ(events[k].id, k & 1);
  }
}

TEST_F(KeptLogsTest, EachStretchBeginsWithTheModeThatLasts) {
  const core::EventId mode =
      vocabulary_.intern({"/logic", "/state", core::typeOfMode("T", "DRIVING")});
  logs().onEvent({kStart, mode}, vocabulary_);
  hear(0, 2 * kStretch + 2);
  ASSERT_TRUE(awaitFiles(2));
  const auto times = [&](const std::string& file) {
    const std::vector<core::Event> events = read(file);
    return std::count_if(events.begin(), events.end(),
                         [&](const core::Event& event) { return event.id == mode; });
  };
  for (const std::string& file : files()) {
    EXPECT_EQ(read(file).front().id, mode) << file;
    EXPECT_EQ(times(file), 1) << file;
  }
  // Another model has other ids.
  logs().setModel(model_, true);
  logs().onCut(Cut::kClockSet);
  hear(2 * kStretch + 10, 2 * kStretch + 30);
  logs().finish();
  EXPECT_EQ(files().size(), 3U);
  EXPECT_EQ(times(files().back()), 0);
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

TEST_F(KeptLogsTest, TheLastStretchIsKeptUnlessItIsTooShortOrLeftOut) {
  hear(0, 11);
  logs().finish();
  EXPECT_EQ(files().size(), 1U);
  logs_.reset();
  hear(0, 10);
  logs().finish();
  logs_.reset();
  hear(0, 60);
  logs().leaveOut("an alarm");
  logs().finish();
  hear(60, 61);  // a last event may still come
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(KeptLogsTest, TheOldestMakeRoom) {
  parameters_.disk = 1;
  boost::filesystem::create_directory(kept_);
  for (const char* const name : {"normal_2020-01-01-00-00-00.000.bag",
                                 "normal_2020-01-02-00-00-00.000.bag", "of_somebody_else.bag"}) {
    writeFile(kept_ + "/" + name, std::string(600000, 'x'));
  }
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
  EXPECT_EQ(robotStart(files()[0]), kRobotStart);
  EXPECT_EQ(robotStart(files()[1]), kStart + 60 * kSecond);
}

}  // namespace
}  // namespace self_awareness
