// Tests that event logs come out as they were written, and that damage is named.

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "../../in_folder.h"
#include "../../problem.h"
#include "../../times.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/bag/event_log_reader.h"
#include "self_awareness/ros/bag/event_log_writer.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::int64_t kBegin = 1790000000 * kSecond;

using Events = std::vector<std::pair<std::int64_t, std::string>>;  // stamp and node

Events eventsOf(std::int64_t begin, int number) {
  Events events;
  for (int k = 0; k < number; ++k) {
    events.emplace_back(begin + k * kSecond / 7, "/node" + std::to_string(k % 3));
  }
  return events;
}

class EventLogTest : public InFolder {
 protected:
  /// Writes a recording: half a second of silence, a node that other ones hear, and the events.
  void write(EventLogWriter& log, std::int64_t begin, std::int64_t robot_start,
             const Events& events) {
    log.start(startOfRecording(rules_, begin - kSecond / 2, robot_start));
    Graph graph;
    graph.topics["/topic"] = {"std_msgs/String", {"/node0"}, {"/node1"}};
    graph.hosts = {{"/node0", "base"}, {"/node1", "base"}};
    log.writeGraph(graph, begin);
    EventLogPacker packer([&](self_awareness::EventLog part) { log.write(std::move(part)); });
    core::Vocabulary vocabulary({{"/other", "/topic", "std_msgs/String"}});  // is never heard
    for (const auto& [stamp, node] : events) {
      packer.add({stamp, vocabulary.intern({node, "/topic", "std_msgs/String"})}, vocabulary);
      packer.add(core::Waiting{stamp, stamp + kSecond / 7, kSecond / 100});
    }
    packer.flush(events.back().first + 2 * kSecond);
    graph.topics["/topic"].subscribers = {"/node2"};
    log.writeGraph(graph, begin);
    graph.hosts["/node1"] = "head";
    log.writeGraph(graph, begin);
  }

  std::string writeLog(const std::string& name) {
    EventLogWriter log(path(name));
    write(log, kBegin, 3 * kSecond, eventsOf(kBegin, 500));
    log.close();
    return path(name);
  }

  Events read(const EventLogReader& log, const TimeRange& range = {}) const {
    Events events;
    core::Vocabulary vocabulary;
    log.read(
        rules_, [&](const core::EventType& type) { return vocabulary.intern(type); }, range,
        [&](const core::Event& event) {
          events.emplace_back(event.stamp, vocabulary.at(event.id).source);
        });
    return events;
  }

  /// How the machine was, of each stretch: begin, end and what was waited [ns].
  std::vector<std::vector<std::int64_t>> waiting(const EventLogReader& log,
                                                 const TimeRange& range = {}) const {
    std::vector<std::vector<std::int64_t>> stretches;
    log.read(
        rules_, [](const core::EventType& /*type*/) { return 0; }, range,
        [](const core::Event&) {}, nullptr,
        [&](const core::Waiting& each) {
          stretches.push_back({each.from, each.to, each.waited});
        });
    return stretches;
  }

  /// What is wrong with a log, as its user is told.
  std::string errorOf(const std::string& log, std::size_t recording = 0) const {
    std::string error = problemOf<BagError>([&] { read(EventLogReader(log, recording)); });
    EXPECT_TRUE(error.empty() || begins(error, log)) << "names the file";
    return error;
  }

  EncodingRules rules_ = EncodingRules::defaults();
};

TEST_F(EventLogTest, EventsComeOutAsTheyWentIn) {
  const std::string log = writeLog("log.bag");
  const EventLogReader reader(log, 0);
  EXPECT_EQ(read(reader), eventsOf(kBegin, 500));
  const BagSummary& summary = reader.summary();
  EXPECT_EQ(summary.start, kBegin - kSecond / 2);
  EXPECT_EQ(summary.end, kBegin + 499 * kSecond / 7 + 2 * kSecond) << "the silence belongs to it";
  EXPECT_EQ(summary.messages, 500U);
  EXPECT_EQ(summary.robot_start, 3 * kSecond);
  EXPECT_EQ(*summary.encoding, rules_);
  EXPECT_EQ(summary.bag, "log.bag");
  EXPECT_EQ(summary.graph.topics.at("/topic").publishers, std::set<std::string>{"/node0"});
  EXPECT_EQ(summary.graph.topics.at("/topic").subscribers,
            (std::set<std::string>{"/node1", "/node2"}))
      << "all who ever listened";
  EXPECT_EQ(summary.graph.hosts,
            (std::map<std::string, std::string>{{"/node0", "base"}, {"/node1", "head"}}))
      << "where they ran last";
  const Events out_of_order{
      {kBegin, "/a"}, {kBegin + 100, "/b"}, {kBegin + 50, "/a"}, {kBegin + 120, "/c"}};
  EventLogWriter other(path("other.bag"));
  write(other, kBegin, 0, out_of_order);
  other.close();
  EXPECT_EQ(read(EventLogReader(other.path(), 0)), out_of_order) << "as they were heard";
}

TEST_F(EventLogTest, WhoSubscribedAtTheEndDidSoAllTheTime) {
  using Subscriptions = std::set<core::SourceGraph::Subscription>;
  EXPECT_EQ(lastingSubscriptions(EventLogReader(writeLog("log.bag"), 0).summary(), rules_),
            (Subscriptions{{"/node2", "/topic"}}))
      << "/node1 left while it started";
  const std::set<std::string> nobody;
  BagSummary summary;
  summary.clock_watched = true;
  summary.end = 1000 * kSecond;
  const auto change = [&](std::int64_t stamp, const std::set<std::string>& subscribers) {
    summary.graph_changes.push_back({stamp, {{"/topic", {"", nobody, subscribers}}}});
  };
  change(10 * kSecond, {});
  change(50 * kSecond, {"/slow", "/always", "/lazy", "/rqt_plot"});
  change(500 * kSecond, {"/slow", "/always", "/later"});
  change(501 * kSecond, {"/slow", "/always", "/later", "/lazy"});
  EXPECT_EQ(lastingSubscriptions(summary, rules_),
            (Subscriptions{{"/always", "/topic"}, {"/slow", "/topic"}}))
      << "neither who left for a moment, who came later, nor a tool";
  summary.end = 80 * kSecond;
  EXPECT_EQ(lastingSubscriptions(summary, rules_), Subscriptions{})
      << "within 40 s of a short recording";
  summary.end = 1000 * kSecond;
  rules_.exclude_topics.emplace_back("/topic");
  EXPECT_EQ(lastingSubscriptions(summary, rules_), Subscriptions{});
  rules_ = EncodingRules::defaults();
  summary.clock_watched = false;
  EXPECT_EQ(lastingSubscriptions(summary, rules_), Subscriptions{})
      << "made of a bag, whose graph does not say who left";
}

TEST_F(EventLogTest, HowTheMachineWasComesOutAsItWentIn) {
  const std::string log = writeLog("log.bag");
  const auto stretches = waiting(EventLogReader(log, 0));
  ASSERT_EQ(stretches.size(), 500U);
  const std::int64_t last = kBegin + 499 * kSecond / 7;
  EXPECT_EQ(stretches.back(),
            (std::vector<std::int64_t>{last, last + kSecond / 7, kSecond / 100}));
  EXPECT_EQ(waiting(EventLogReader(log, 0), {10.5, 11.6}).size(), 7U) << "a second of it";
}

TEST_F(EventLogTest, AMachineThatWaitedForLongerThanTimePassedIsDamage) {
  for (const core::Waiting& wrong :
       {core::Waiting{kBegin, kBegin + 5, 6}, core::Waiting{kBegin, kBegin - 1, 0},
        core::Waiting{-1, kBegin, 1}, core::Waiting{kBegin, kBegin + 5, -1}}) {
    EventLogWriter log(path("wrong.bag"));
    log.start(startOfRecording(rules_, kBegin));
    EventLogPacker packer([&](self_awareness::EventLog part) { log.write(std::move(part)); });
    packer.add(wrong);
    packer.flush(kBegin + kSecond);
    log.close();
    EXPECT_THROW(waiting(EventLogReader(path("wrong.bag"), 0)), BagError);
  }
}

TEST_F(EventLogTest, ARangeIsCountedFromTheStart) {
  const EventLogReader reader(writeLog("log.bag"), 0);
  const auto events = read(reader, {1.5, 2.5});
  ASSERT_EQ(events.size(), 8U);
  EXPECT_EQ(events.front().first, kBegin + kSecond);
  EXPECT_EQ(events.back().first, kBegin + 2 * kSecond);
  EXPECT_THROW(read(reader, {1000.0, std::nullopt}), BagError);
}

TEST_F(EventLogTest, HoldsSeveralRecordingsInTheirOrder) {
  EventLogWriter log(path("log.bag"));
  write(log, kBegin, 1 * kSecond, eventsOf(kBegin, 30));
  write(log, kBegin - 3600 * kSecond, 2 * kSecond, eventsOf(kBegin - 3600 * kSecond, 20));
  log.close();
  EXPECT_EQ(recordingsInEventLog(log.path()), 2U) << "though the clock was set back";
  EXPECT_EQ(read(EventLogReader(log.path(), 0)), eventsOf(kBegin, 30));
  EXPECT_EQ(read(EventLogReader(log.path(), 1)), eventsOf(kBegin - 3600 * kSecond, 20));
  EXPECT_TRUE(has(errorOf(log.path(), 2), "holds 2 recordings"));
}

TEST_F(EventLogTest, SilenceIsHandedOutToo) {
  std::vector<self_awareness::EventLog> parts;
  EventLogPacker packer([&](self_awareness::EventLog part) { parts.push_back(std::move(part)); });
  packer.advance(kBegin);
  packer.advance(kBegin + EventLogPacker::kLongestPart - 1);
  EXPECT_EQ(parts.size(), 0U);
  packer.advance(kBegin + EventLogPacker::kLongestPart);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].events, 0U);
  EXPECT_EQ(parts[0].heard_until.toNSec(),
            static_cast<std::uint64_t>(kBegin + EventLogPacker::kLongestPart));
}

TEST_F(EventLogTest, NamesAreWholeAndRenamedByWhatTheLogWasNotYet) {
  rules_.renames = {{"/r1/(.*)", "/\\1"}};
  EventLogWriter log(path("log.bag"));
  write(log, kBegin, 0, {{kBegin, "node_7"}, {kBegin + kSecond, "/node_7"}, {kBegin, "//other"}});
  log.close();
  const EventLogReader reader(path("log.bag"), 0);
  const auto names = [&] {
    std::set<std::string> names;
    for (const auto& [stamp, source] : read(reader)) {
      names.insert(source);
    }
    return names;
  };
  EXPECT_EQ(names(), (std::set<std::string>{"/node_7", "/other"}));
  rules_.renames.push_back({"/node_[0-9]+", "/node"});
  EXPECT_EQ(names(), (std::set<std::string>{"/node", "/other"}));
  EXPECT_EQ(reader.eventTypes(rules_),
            (std::set<core::EventType>{{"/node", "/topic", "std_msgs/String"},
                                       {"/other", "/topic", "std_msgs/String"}}));
  rules_.renames.erase(rules_.renames.begin());
  EXPECT_TRUE(has(errorOf(path("log.bag")), "another encoding"));
}

TEST_F(EventLogTest, WhatIsNoWholeLogIsToldInItsWords) {
  const std::string log = writeLog("log.bag");
  rosbag::Bag bag(path("a.bag"), rosbag::bagmode::Write);
  bag.write("/a", ros::Time(1, 0), self_awareness::EventLog());
  bag.write("/b", ros::Time(1, 0), self_awareness::EventType());
  bag.close();
  EXPECT_FALSE(recordingsInEventLog(path("a.bag"))) << "somebody recorded a log's topic";
  EXPECT_FALSE(recordingsInEventLog(path("none.bag")));
  EXPECT_TRUE(has(errorOf(path("a.bag")), "no event log"));
  bag.open(path("a.bag"), rosbag::bagmode::Write);
  bag.write(kEventLogTopic, ros::Time(1, 0), self_awareness::EventLog());
  bag.close();
  EXPECT_TRUE(has(errorOf(path("a.bag")), "no start"));
  {
    EventLogWriter unfinished(path("b.bag"));
    write(unfinished, kBegin, 3 * kSecond, eventsOf(kBegin, 500));
  }
  EXPECT_TRUE(has(errorOf(path("b.bag")), "has no index"));
  {
    const rosbag::Bag from(log, rosbag::bagmode::Read);
    rosbag::Bag to(path("cut.bag"), rosbag::bagmode::Write);
    std::size_t parts = 0;
    for (const rosbag::MessageInstance& message : rosbag::View(from)) {
      if (message.getTopic() != kEventLogTopic || ++parts != 2) {
        to.write(message.getTopic(), message.getTime(), message);
      }
    }
    ASSERT_GT(parts, 2U);
  }
  EXPECT_TRUE(has(errorOf(path("cut.bag")), "a part is missing"));
  rules_.exclude_topics.emplace_back("/other");
  EXPECT_TRUE(has(errorOf(log), "another encoding"));
}

TEST_F(EventLogTest, NamesThatNoTerminalShouldGetAreRefused) {
  struct Log {
    self_awareness::EventLogStart start;
    core::EventType type{"/node", "/topic", "std_msgs/String"};
    std::string publisher = "/node";
  };
  using Change = std::function<void(Log&)>;
  const auto error = [this](const Change& change) {
    Log named{startOfRecording(rules_, kBegin)};
    change(named);
    EventLogWriter log(path("named"));
    log.start(named.start);
    EventLogPacker packer([&](self_awareness::EventLog part) { log.write(std::move(part)); });
    packer.add({kBegin, 0}, core::Vocabulary({named.type}));
    packer.flush(kBegin + kSecond);
    Graph graph;
    graph.topics["/topic"].publishers = {named.publisher};
    log.writeGraph(graph, kBegin);
    log.close();
    return errorOf(path("named"));
  };
  EXPECT_EQ(error([](Log& /*log*/) {}), "");
  const std::string escape = "a\x1B[2J";
  for (const Change& change :
       std::vector<Change>{[&](Log& log) { log.start.bag = escape; },
                           [&](Log& log) { log.start.encoding.exclude_topics = {escape}; },
                           [&](Log& log) { log.type.source = escape; },
                           [&](Log& log) { log.type.type = std::string("a\xE2\x80\xAE") + "b"; },
                           [&](Log& log) { log.publisher = escape; }}) {
    const std::string told = error(change);
    EXPECT_NE(told, "");
    EXPECT_EQ(told.find('\x1B'), std::string::npos);
  }
}

}  // namespace
}  // namespace self_awareness::ros1
