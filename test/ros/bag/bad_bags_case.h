#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "../../in_folder.h"
#include "../../problem.h"
#include "bag_bytes.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/event_log_reader.h"
#include "self_awareness/ros/bag/event_log_writer.h"

namespace self_awareness::ros1 {

/// Bags and event logs that a test has changed.
class BadBagsTest : public InFolder {
 protected:
  BadBagsTest() {
    parts_.messages = {
        {100, bag_bytes::block("x")}, {101, bag_bytes::block("y")}, {102, bag_bytes::block("z")}};
    rules_.type_fields = {{"std_msgs/String", "data"}};
  }
  /// What is wrong with a bag; empty: it was read.
  std::string errorOf(const std::string& bytes) {
    writeFile(path("bad.bag"), bytes);
    events_.clear();
    vocabulary_ = {};
    try {
      const Encoder encoder(
          rules_, [this](const core::EventType& type) { return vocabulary_.intern(type); });
      BagReader(path("bad.bag")).read(encoder, {}, [this](const core::Event& event) {
        events_.push_back(event);
      });
    } catch (const BagError& error) {
      EXPECT_TRUE(begins(error.what(), path("bad.bag") + ": "));
      return error.what();
    } catch (const std::invalid_argument& error) {  // the definition; the caller names the bag
      return error.what();
    }
    return "";
  }
  std::string errorOfLog(const std::string& bytes) {
    writeFile(path("bad.log"), bytes);
    events_.clear();
    vocabulary_ = {};
    const std::string error = problemOf<BagError>([this] {
      const std::size_t recordings = recordingsInEventLog(path("bad.log")).value_or(1);
      for (std::size_t k = 0; k < std::min<std::size_t>(recordings, 3); ++k) {
        const EventLogReader log(path("bad.log"), k);
        log.read(
            *log.summary().encoding,
            [this](const core::EventType& type) { return vocabulary_.intern(type); }, {},
            [this](const core::Event& event) { events_.push_back(event); });
      }
    });
    EXPECT_TRUE(error.empty() || begins(error, path("bad.log") + ": "));
    return error;
  }
  /// Three chunks of three messages each.
  std::string threeChunks() {
    std::vector<std::string> chunks;
    for (std::uint32_t k = 0; k < 3; ++k) {
      for (auto& [second, content] : parts_.messages) {
        second += 10;
      }
      chunks.push_back(parts_.indexedChunk());
    }
    return parts_.bag(chunks);
  }
  std::string eventLog() {
    writeFile(path("good.bag"), parts_.bag());
    EventLogWriter log(path("good.log"));
    Graph graph;
    graph.topics["/a"] = {"std_msgs/String", {"/node"}, {"/other"}};
    addToEventLog(BagReader(path("good.bag")), rules_, graph, log);
    log.close();
    return readFile(path("good.log"));
  }

  bag_bytes::Parts parts_;
  EncodingRules rules_;
  core::Vocabulary vocabulary_;
  std::vector<core::Event> events_;
};

}  // namespace self_awareness::ros1
