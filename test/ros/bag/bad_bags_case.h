#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/filesystem.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "bag_bytes.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/bag_to_event_log.h"
#include "self_awareness/ros/bag/event_log_reader.h"

namespace self_awareness::ros1 {

/// Bags and event logs that a test has changed.
class BadBagsTest : public testing::Test {
 protected:
  BadBagsTest()
      : folder_(boost::filesystem::temp_directory_path() /
                boost::filesystem::unique_path("self_awareness-%%%%%%%%")) {
    boost::filesystem::create_directory(folder_);
    parts_.messages = {
        {100, bag_bytes::block("x")}, {101, bag_bytes::block("y")}, {102, bag_bytes::block("z")}};
    rules_.type_fields = {{"std_msgs/String", "data"}};
  }
  ~BadBagsTest() override { boost::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// What is wrong with a bag; empty: it was read.
  std::string errorOf(const std::string& bytes) {
    bag_bytes::writeFile(path("bad.bag"), bytes);
    events_.clear();
    vocabulary_ = {};
    try {
      const Encoder encoder(
          rules_, [this](const core::EventType& type) { return vocabulary_.intern(type); });
      BagReader(path("bad.bag")).read(encoder, {}, [this](const core::Event& event) {
        events_.push_back(event);
      });
    } catch (const BagError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(path("bad.bag") + ": ", 0), 0U) << error.what();
      return error.what();
    } catch (const std::invalid_argument& error) {  // the definition; the caller names the bag
      return error.what();
    }
    return "";
  }
  std::string errorOfLog(const std::string& bytes) {
    bag_bytes::writeFile(path("bad.log"), bytes);
    events_.clear();
    vocabulary_ = {};
    try {
      const std::size_t recordings = recordingsInEventLog(path("bad.log")).value_or(1);
      for (std::size_t k = 0; k < std::min<std::size_t>(recordings, 3); ++k) {
        const EventLogReader log(path("bad.log"), k);
        log.read(
            *log.summary().encoding,
            [this](const core::EventType& type) { return vocabulary_.intern(type); }, {},
            [this](const core::Event& event) { events_.push_back(event); });
      }
    } catch (const BagError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(path("bad.log") + ": ", 0), 0U) << error.what();
      return error.what();
    }
    return "";
  }
  static bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }
  /// Three chunks of three messages each.
  std::string threeChunks() {
    std::vector<std::string> chunks;
    for (std::uint32_t k = 0; k < 3; ++k) {
      for (auto& [second, content] : parts_.messages) {
        second += 10;
      }
      const std::string data = parts_.chunk();
      chunks.push_back(parts_.chunkRecord(data, static_cast<std::uint32_t>(data.size())) +
                       parts_.indexRecord());
    }
    return parts_.bag(chunks);
  }
  std::string eventLog() {
    bag_bytes::writeFile(path("good.bag"), parts_.bag());
    EventLogWriter log(path("good.log"));
    Graph graph;
    graph.topics["/a"] = {"std_msgs/String", {"/node"}, {"/other"}};
    addToEventLog(BagReader(path("good.bag")), rules_, graph, log);
    log.close();
    return bag_bytes::readFile(path("good.log"));
  }

  boost::filesystem::path folder_;
  bag_bytes::Parts parts_;
  EncodingRules rules_;
  core::Vocabulary vocabulary_;
  std::vector<core::Event> events_;
};

}  // namespace self_awareness::ros1
