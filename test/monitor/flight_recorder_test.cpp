#include "monitor/flight_recorder.h"

#include <gtest/gtest.h>
#include <sys/types.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>

#include "../await.h"
#include "../in_folder.h"
#include "../problem.h"
#include "../times.h"
#include "self_awareness/ros/bag/event_log_reader.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness {
namespace {

constexpr std::int64_t kSteady = 5000 * kSecond;  // steady time at the start [ns]

class FlightRecorderTest : public InFolder {
 protected:
  FlightRecorderTest() {
    parameters_.directory = recorded_.string();
    vocabulary_.intern({"/player", "/scan", "T"});
    vocabulary_.intern({"/slam", "/pose", "T"});
    auto graph = std::make_shared<ros1::Graph>();
    graph->topics["/scan"].publishers = {"/player"};
    source_ = {ros1::EncodingRules::defaults(), graph};
  }

  FlightRecorder& recorder() {
    if (!recorder_) {
      recorder_ = std::make_unique<FlightRecorder>(parameters_, [this] { return source_; });
    }
    return *recorder_;
  }
  /// An event each 10 ms, one type after the other, from `from` to before `to` [s].
  void hear(double from, double to) {
    for (auto i = static_cast<int>(from * 100); i < static_cast<int>(to * 100); ++i) {
      const core::Event event{kStart + i * kSecond / 100, static_cast<core::EventId>(i & 1)};
      recorder().onEvent(event, vocabulary_);
      heard_.push_back(event);
      tick(event.stamp);
    }
  }
  void tick(std::int64_t ros) { recorder().onTick({ros, steady(ros), ros}); }
  /// An alarm is raised. @return path of its file; empty: it has none
  std::string raise() {
    core::Verdict verdict;
    verdict.alarm = true;
    ros1::Circumstances circumstances;
    recorder().onVerdict(verdict, circumstances);
    return circumstances.recording;
  }
  /// An alarm of before the start stands.
  void stand() {
    self_awareness::StandingAlarm before;
    before.since = ros1::toRosTime(kStart);
    before.alarm.level = SelfAwareness::ERROR;
    before.alarm.kind = SelfAwareness::SILENT;
    ros1::AlarmState state;
    state.resume(before, {});
    recorder().onAlarm(state);
  }
  static std::int64_t steady(std::int64_t ros) { return ros - kStart + kSteady; }
  bool awaitFiles(std::uint64_t number) {
    return await([&] { return recorder().report().files.written == number; });
  }
  std::set<std::string> files() const {
    return exists(recorded_) ? names("recorder") : std::set<std::string>();
  }
  /// The monitor ends.
  void end() {
    recorder().finish();
    recorder_.reset();
  }
  /// Writes what it has. @return its events
  std::vector<core::Event> dumped() {
    const std::string path = recorder().dump().value();
    EXPECT_TRUE(awaitFiles(1));
    return read(path);
  }
  /// The events of a file, by the ids of the vocabulary.
  std::vector<core::Event> read(const std::string& path) {
    const ros1::EventLogReader reader(path, 0);
    std::vector<core::Event> events;
    reader.read(
        source_.encoding, [&](const core::EventType& type) { return *vocabulary_.find(type); }, {},
        [&](const core::Event& event) { events.push_back(event); });
    return events;
  }
  void expectSame(const std::vector<core::Event>& found, std::size_t first, std::size_t last) {
    ASSERT_EQ(found.size(), last - first);
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_EQ(found[i].stamp, heard_[first + i].stamp) << i;
      ASSERT_EQ(found[i].id, heard_[first + i].id) << i;
    }
  }

  const boost::filesystem::path recorded_ = folder_ / "recorder";
  RecorderParameters parameters_;
  ros1::LogSource source_;
  core::Vocabulary vocabulary_;
  std::vector<core::Event> heard_;
  std::unique_ptr<FlightRecorder> recorder_;
};

TEST_F(FlightRecorderTest, AnAlarmIsWrittenWithWhatFollows) {
  parameters_.after = 5;
  hear(0, 20);
  tick(kStart + 20 * kSecond);
  const std::string path = raise();
  EXPECT_TRUE(begins(path, (recorded_ / "alarm_").string()));
  hear(20, 24.99);
  EXPECT_EQ(recorder().report().files.written + recorder().report().files.waiting_bytes, 0U);
  hear(24.99, 26);
  ASSERT_TRUE(awaitFiles(1));
  expectSame(read(path), 0, 2501);
  const ros1::EventLogReader reader(path, 0);
  EXPECT_EQ(reader.summary().start, kStart);
  EXPECT_EQ(reader.summary().encoding, source_.encoding);
  EXPECT_TRUE(reader.summary().has_sources);
  EXPECT_EQ(reader.summary().graph.topics.count("/scan"), 1U);
  EXPECT_EQ(files().size(), 1U) << "no temporary file is left";

  const std::string next = raise();
  EXPECT_NE(next, path);
  EXPECT_EQ(raise(), next) << "it follows soon";
  tick(kStart + 31 * kSecond);
  ASSERT_TRUE(awaitFiles(2));
  EXPECT_EQ(ros1::EventLogReader(next, 0).summary().end, kStart + 31 * kSecond)
      << "silence belongs to it";
  expectSame(read(next), 0, 2600);
}

TEST_F(FlightRecorderTest, TheOldestEventsAreForgotten) {
  parameters_.duration = 30;
  hear(0, 400);
  EXPECT_GE(recorder().report().seconds, 30);
  EXPECT_LE(recorder().report().seconds,
            30 + 2 * core::toSeconds(ros1::EventLogPacker::kLongestPart))
      << "whole parts are forgotten";
  const std::vector<core::Event> events = dumped();
  ASSERT_GE(events.size(), 3000U);
  expectSame(events, heard_.size() - events.size(), heard_.size());
}

TEST_F(FlightRecorderTest, ManyEventsDoNotFillTheMemory) {
  parameters_.memory = 1;
  for (int i = 0; i < 2000000; ++i) {  // 100 s of 20,000 events a second
    recorder().onEvent({kStart + i * 50000L, static_cast<core::EventId>(i % 2)}, vocabulary_);
  }
  EXPECT_LE(recorder().report().bytes, 1000000U);
  EXPECT_GE(recorder().report().bytes, 800000U);
  const double seconds = recorder().report().seconds;
  EXPECT_LT(seconds, 99);
  const std::vector<core::Event> events = dumped();
  EXPECT_NEAR(static_cast<double>(events.size()), 20000 * seconds, 40000);
  EXPECT_EQ(events.back().stamp, kStart + 1999999 * 50000L);
}

TEST_F(FlightRecorderTest, AnEventTypeThatWasHeardLongAgoKeepsItsName) {
  parameters_.duration = 30;
  for (int i = 0; i < 2000; ++i) {  // /pose first, so that its number is no accident
    const core::Event event{kStart + i * kSecond / 10, i % 7 == 0 ? 1U : 0U};
    recorder().onEvent(event, vocabulary_);
    heard_.push_back(event);
  }
  const core::EventId late = vocabulary_.intern({"/joy", "/joy", "T"});
  heard_.push_back({kStart + 200 * kSecond, late});
  recorder().onEvent(heard_.back(), vocabulary_);
  const std::vector<core::Event> events = dumped();
  ASSERT_LT(events.size(), 1000U) << "less than half";
  expectSame(events, heard_.size() - events.size(), heard_.size());
}

TEST_F(FlightRecorderTest, WhatComesAfterARestartIsAnotherRecording) {
  hear(0, 20);
  const std::string path = raise();
  recorder().onCut(Cut::kClockSet);
  ASSERT_TRUE(awaitFiles(1)) << "what follows would be of another time, or another model";
  expectSame(read(path), 0, 2000);
  EXPECT_FALSE(recorder().dump()) << "nothing was heard since";
  heard_.clear();
  hear(-3600, -3590);
  const std::string second = recorder().dump().value();
  ASSERT_TRUE(awaitFiles(2));
  expectSame(read(second), 0, 1000);
}

TEST_F(FlightRecorderTest, AtTheEndAnAlarmThatStandsIsWritten) {
  hear(0, 1);
  end();
  EXPECT_FALSE(exists(recorded_)) << "no alarm stood";
  hear(0, 1);
  stand();
  end();
  ASSERT_EQ(files().size(), 1U);
  EXPECT_TRUE(begins(*files().begin(), "shutdown_"));
  heard_.clear();
  hear(1, 2);
  const std::string path = raise();
  end();
  EXPECT_EQ(files().size(), 2U) << "the alarm is in its own file, which waits for nothing";
  expectSame(read(path), 0, 100);
}

TEST_F(FlightRecorderTest, WithoutADurationThereIsNone) {
  parameters_.duration = 0;
  EXPECT_FALSE(recorder().enabled());
  hear(0, 1);
  EXPECT_EQ(raise(), "");
  EXPECT_FALSE(recorder().dump());
  stand();
  end();
  EXPECT_FALSE(exists(recorded_));
}

// SELF_AWARENESS_KILLS says how often (scripts/kill.sh).
TEST_F(FlightRecorderTest, AKillLeavesWholeFilesOnly) {
  const char* number = std::getenv("SELF_AWARENESS_KILLS");
  const int kills = number == nullptr ? 4 : std::atoi(number);
  ASSERT_GT(kills, 0);
  std::mt19937 random(1);
  for (int i = 0; i < kills; ++i) {
    const pid_t node = ::fork();
    if (node == 0) {
      parameters_.files = 3;
      hear(0, 20);
      while (recorder().dump()) {
        await([&] { return recorder().report().files.waiting_bytes == 0; });
      }
    }
    ASSERT_TRUE(await([&] { return !files().empty(); }));
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
    ::kill(node, SIGKILL);
    ASSERT_EQ(::waitpid(node, nullptr, 0), node);
    for (const std::string& name : files()) {
      if ((recorded_ / name).extension() == ".bag" && name[0] != '.') {
        EXPECT_EQ(read((recorded_ / name).string()).size(), 2000U);
      }
    }
  }
  hear(0, 20);
  recorder().dump();
  ASSERT_TRUE(awaitFiles(1));
  for (const std::string& name : files()) {
    EXPECT_NE(name[0], '.') << name << " is left of one that was killed";
  }
}

}  // namespace
}  // namespace self_awareness
