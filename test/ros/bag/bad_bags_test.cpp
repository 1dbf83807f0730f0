// Bags that were damaged, or made to do harm: each is read, or refused in words that name the
// file. What is in their chunks is compared with what their index says, compressed or not.

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <roslz4/lz4s.h>
#include <std_msgs/String.h>
#include <sys/resource.h>

#include <algorithm>
#include <boost/filesystem.hpp>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../../in_folder.h"
#include "../../problem.h"
#include "bag_bytes.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/event_log_reader.h"
#include "self_awareness/ros/bag/event_log_writer.h"

namespace self_awareness::ros1 {
namespace {

/// Bags and event logs that a test has changed.
class BadBagsTest : public InFolder {
 protected:
  BadBagsTest() {
    parts_.messages = {
        {100, bag_bytes::block("x")}, {101, bag_bytes::block("y")}, {102, bag_bytes::block("z")}};
    rules_.type_fields = {{"std_msgs/String", "data"}};
  }
  /// What is wrong with a bag, or an event log; empty: it was read.
  std::string errorOf(const std::string& bytes) {
    writeFile(path("bad.bag"), bytes);
    events_.clear();
    vocabulary_ = {};
    std::optional<std::size_t> recordings;  // of an event log
    const auto intern = [this](const core::EventType& type) { return vocabulary_.intern(type); };
    const auto keep = [this](const core::Event& event) { events_.push_back(event); };
    try {
      recordings = recordingsInEventLog(path("bad.bag"));
      if (!recordings) {
        BagReader(path("bad.bag")).read(Encoder(rules_, intern), {}, keep);
      }
      for (std::size_t k = 0; k < std::min<std::size_t>(recordings.value_or(0), 3); ++k) {
        const EventLogReader log(path("bad.bag"), k);
        log.read(*log.summary().encoding, intern, {}, keep);
      }
    } catch (const BagError& error) {
      EXPECT_TRUE(begins(error.what(), path("bad.bag") + ": "));
      return error.what();
    } catch (const std::invalid_argument& error) {  // the definition; the caller names the bag
      EXPECT_FALSE(recordings) << "a log is damaged, or it is not";
      return error.what();
    }
    return "";
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

namespace fs = boost::filesystem;
using bag_bytes::block;
using bag_bytes::bytesOf;
using bag_bytes::Parts;

// What this process may allocate beyond what it has [bytes]: a length that is believed needs more.
constexpr std::uint64_t kEnough = 256 << 20;

/// Lets no test allocate what a lying number asks for.
class MemoryLimit {
 public:
  MemoryLimit() {
    getrlimit(RLIMIT_AS, &before_);
#ifndef __SANITIZE_THREAD__  // ThreadSanitizer allocates more than that for itself
    std::ifstream statm("/proc/self/statm");
    std::uint64_t pages = 0;
    statm >> pages;
    rlimit limit = before_;
    limit.rlim_cur = pages * 4096 + kEnough;
    setrlimit(RLIMIT_AS, &limit);
#endif
  }
  ~MemoryLimit() {
    setrlimit(RLIMIT_AS, &before_);
  }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
};

TEST_F(BadBagsTest, ABagIsRefusedWhereverItIsCutWithTheRepair) {
  const MemoryLimit limit;
  for (const std::string& whole : {threeChunks(), eventLog()}) {
    for (const std::size_t boundary : bag_bytes::boundaries(whole)) {
      for (const std::size_t cut : {boundary - 1, boundary, boundary + 1, boundary + 5}) {
        if (cut < whole.size()) {
          EXPECT_TRUE(has(errorOf(whole.substr(0, cut)), "rosbag reindex '")) << cut;
        }
      }
    }
  }
}

TEST_F(BadBagsTest, NoFlippedBitIsBelievedInSilence) {
  const MemoryLimit limit;
  const std::string whole = threeChunks();
  ASSERT_EQ(errorOf(whole), "");
  const std::vector<core::Event> events = events_;
  ASSERT_EQ(events.size(), 9U);
  const std::size_t first = bag_bytes::boundaries(whole)[1];
  for (std::size_t at = first; at < whole.size(); ++at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 1 << at % 8);
    // What is read in spite of it has all events at their times, or none under a name that cannot
    // be: contents and names may differ.
    if (errorOf(bytes).empty() && BagReader(path("bad.bag")).summary().left_out.empty()) {
      ASSERT_EQ(events_.size(), events.size()) << at;
      for (std::size_t k = 0; k < events.size(); ++k) {
        ASSERT_EQ(events_[k].stamp, events[k].stamp) << at;
      }
    }
  }
}

TEST_F(BadBagsTest, ALyingLengthAsksForNoMemory) {
  const MemoryLimit limit;
  std::size_t refused = 0;
  for (const std::string& whole : {threeChunks(), eventLog()}) {
    for (std::size_t at = 13; at + 4 < whole.size(); ++at) {
      std::uint32_t length = 0;
      std::memcpy(&length, &whole[at], sizeof length);
      if (length > 5000 || (at > 200 && at < 4000)) {
        continue;  // no length, or the blanks after the file's header
      }
      for (const std::uint32_t lie : {0xFFFFFFFFU, 0x3FFFFFFFU, length ^ 1U}) {
        std::string bytes = whole;
        bytes.replace(at, sizeof lie, bytesOf(lie));
        const std::string error = errorOf(bytes);
        EXPECT_FALSE(has(error, "memory")) << at << ": " << error;
        refused += error.empty() ? 0 : 1;
      }
    }
  }
  EXPECT_GT(refused, 1000U);
}

TEST_F(BadBagsTest, SwappedAndRepeatedBlocksAreRefused) {
  const std::string whole = threeChunks();
  const std::vector<std::size_t> begins = bag_bytes::boundaries(whole);
  const auto piece = [&](std::size_t k) {
    return whole.substr(begins[k], begins[k + 1] - begins[k]);
  };
  for (std::size_t k = 1; k + 1 < begins.size(); ++k) {
    std::string repeated = whole;
    repeated.insert(begins[k + 1], piece(k));
    EXPECT_NE(errorOf(repeated), "") << k;
    std::string left_out = whole;
    left_out.erase(begins[k], begins[k + 1] - begins[k]);
    EXPECT_NE(errorOf(left_out), "") << k;
  }
  // A chunk and its index, with those after them: of the same lengths, so all positions fit.
  std::string swapped = whole;
  swapped.replace(begins[1], begins[5] - begins[1], piece(3) + piece(4) + piece(1) + piece(2));
  EXPECT_EQ(errorOf(swapped), "") << "the order of chunks says nothing";
  swapped = whole;
  swapped.replace(begins[1], begins[5] - begins[1], piece(1) + piece(4) + piece(3) + piece(2));
  EXPECT_TRUE(has(errorOf(swapped), "its index and its messages contradict each other"));
}

TEST_F(BadBagsTest, AChunkThatIsThereTwiceOrNotAtAllOrEncryptedIsRefused) {
  const std::string chunk = parts_.indexedChunk();
  const std::uint64_t first = Parts::fileHeader(0, 0, 0).size();
  const auto bag = [&](const std::vector<std::uint64_t>& positions) {
    std::string infos;
    for (const std::uint64_t position : positions) {
      infos += Parts::chunkInfo(first + position, 3);
    }
    return Parts::fileHeader(first + 2 * chunk.size(), 1,
                             static_cast<std::uint32_t>(positions.size())) +
           chunk + chunk + parts_.connectionRecord() + infos;
  };
  EXPECT_TRUE(has(errorOf(bag({0, 0})), "a chunk twice"));
  EXPECT_TRUE(has(errorOf(bag({0})), "leaves out a chunk"));
  EXPECT_TRUE(has(errorOf(bag({chunk.size()})), "leaves out a chunk"));
  EXPECT_TRUE(has(errorOf(bag({chunk.size(), 0})), "leaves out a chunk"));
  EXPECT_TRUE(has(errorOf(bag({0, chunk.size()})), "the same messages twice"));
  const std::string index = parts_.connectionRecord() + Parts::chunkInfo(first, 3);
  EXPECT_EQ(errorOf(Parts::fileHeader(first + chunk.size() + index.size(), 1, 1) + chunk + index +
                    index),
            "")
      << "`rosbag reindex` writes an index behind one that was cut off";
  const std::string rest = chunk.substr(0, 50);  // as `rosbag reindex` leaves it
  EXPECT_TRUE(
      has(errorOf(Parts::fileHeader(first + rest.size(), 1, 0) + rest + parts_.connectionRecord()),
          "holds no messages"));
  const std::string header = bag_bytes::record({{"op", "\x03"},
                                                {"index_pos", bytesOf(std::uint64_t{4200})},
                                                {"conn_count", bytesOf(std::uint32_t{1})},
                                                {"chunk_count", bytesOf(std::uint32_t{1})},
                                                {"encryptor", "rosbag/NoEncryptor"}},
                                               "");
  EXPECT_TRUE(has(errorOf("#ROSBAG V2.0\n" + header), "rosbag encrypt"));
}

TEST_F(BadBagsTest, WhatHasTheTimeZeroIsLeftOutAndTold) {
  parts_.messages[0].first = 0;
  EXPECT_EQ(errorOf(parts_.bag()), "");
  EXPECT_EQ(events_.size(), 2U);
  EXPECT_EQ(BagReader(path("bad.bag")).summary().left_out,
            std::vector<std::string>{"what has the time 0 (1 messages)"});
  for (auto& [second, content] : parts_.messages) {
    second = 0;
  }
  EXPECT_TRUE(has(errorOf(parts_.bag()), "all its messages have the time 0; write it again"));
}

TEST_F(BadBagsTest, AChunkThatAnnouncesGigabytesIsRefused) {
  const MemoryLimit limit;
  const std::string zeros(1000, '\0');
  for (const char* compression : {"none", "lz4", "bz2", "zip"}) {
    parts_.compression = compression;
    for (const std::uint32_t announced : {0xFFFFFFFFU, 0x40000001U, 1000000U}) {
      const std::string error =
          errorOf(parts_.bag({parts_.chunkRecord(zeros, announced) + parts_.indexRecord()}));
      EXPECT_NE(error, "") << compression;
      EXPECT_FALSE(has(error, "memory")) << error;
    }
  }
}

TEST_F(BadBagsTest, AListOfChunksAsLongAsAHoleInTheFileIsRefused) {
  const MemoryLimit limit;
  std::string bytes = Parts::fileHeader(4200, 1, 0xFFFFFFFF);
  bytes.resize(4200);
  bytes += parts_.connectionRecord();
  writeFile(path("hole.bag"), bytes);
  fs::resize_file(path("hole.bag"), std::uintmax_t{3} << 30);  // takes no room on the disk
  const std::string error = problemOf<BagError>([this] { BagReader(path("hole.bag")); });
  EXPECT_TRUE(!error.empty() && !has(error, "memory")) << error;
}

TEST_F(BadBagsTest, EveryTimeThatABagCanHoldIsReadOrRefused) {
  parts_.messages = {{1, block("x")}, {0xFFFFFFFF, block("y")}};
  parts_.nanoseconds = 999999999;
  EXPECT_EQ(errorOf(parts_.bag()), "");
  EXPECT_EQ(events_.back().stamp, 4294967295999999999);
  EXPECT_EQ(errorOf(eventLog()), "") << "to the last second";
  EXPECT_EQ(events_.size(), 2U);
  parts_.nanoseconds = 1000000000;
  EXPECT_TRUE(has(errorOf(parts_.bag()), "a time that cannot be"));
}

TEST_F(BadBagsTest, NamesAreUtf8WhateverTheBagSays) {
  parts_.callerid = "/m\xFCller";                                    // Latin-1
  parts_.messages = {{1, block(std::string(63, 'x') + "\xC3\xA4")},  // cut in the middle of ae
                     {2, block("\xFF\n\x1B[2J")}};
  EXPECT_EQ(errorOf(parts_.bag()), "");
  EXPECT_EQ(vocabulary_.at(0).source, "/m\xEF\xBF\xBDller");
  EXPECT_EQ(vocabulary_.at(0).type, "std_msgs/String[data=" + std::string(63, 'x') + "]");
  EXPECT_EQ(vocabulary_.at(1).type,
            "std_msgs/String[data=\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD[2J]");
}

TEST_F(BadBagsTest, TopicsThatNoNodeCanSubscribeToAreLeftOutAndNamed) {
  for (const std::string& topic :
       {std::string("/scan-front"), std::string("/a b"), std::string("/m\xFCller"),
        std::string("/a:b"), "/" + std::string(30000, 'a')}) {
    parts_.topic = topic;
    EXPECT_EQ(errorOf(parts_.bag()), "") << topic;
    EXPECT_TRUE(events_.empty());
    const std::vector<std::string> left_out = BagReader(path("bad.bag")).summary().left_out;
    ASSERT_EQ(left_out.size(), 1U);
    EXPECT_TRUE(has(left_out[0], topic.substr(0, 2))) << left_out[0];
    EXPECT_LT(left_out[0].size(), 200U);
  }
  parts_.topic = "/a";
  parts_.callerid = "/" + std::string(30000, 'n');
  EXPECT_EQ(errorOf(parts_.bag()), "");
  EXPECT_TRUE(events_.empty());
}

/// What rosbag makes of messages: compressed, in chunks of a few.
class PackedBagsTest : public BadBagsTest {
 protected:
  std::string packed(rosbag::CompressionType compression) {
    rosbag::Bag bag(path("packed.bag"), rosbag::bagmode::Write);
    bag.setCompression(compression);
    bag.setChunkThreshold(1000);
    std_msgs::String message;
    for (std::uint32_t k = 0; k < 60; ++k) {
      message.data = std::string(50, static_cast<char>('a' + k % 20));
      bag.write("/a", ros::Time(100 + k, 0), message);
    }
    bag.close();
    return readFile(path("packed.bag"));
  }
};

TEST_F(PackedBagsTest, DamageInACompressedChunkIsToldWithTheChunk) {
  rules_.type_fields.clear();  // no message is read for what is in it
  rules_.source = EncodingRules::Source::kNone;
  for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const std::string whole = packed(compression);
    ASSERT_EQ(errorOf(whole), "");
    ASSERT_EQ(events_.size(), 60U);
    // A header, then chunks, each with its index. Of the second one, the header is left alone.
    const std::vector<std::size_t> records = bag_bytes::boundaries(whole);
    std::uint32_t header = 0;
    std::memcpy(&header, &whole[records.at(3)], sizeof header);
    const std::size_t begin = records[3] + 2 * sizeof header + header;
    const std::size_t end = records[4];
    for (std::size_t at = begin; at < end; ++at) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ 1 << at % 8);
      const std::string error = errorOf(bytes);
      // A few bits of a frame mean nothing; then all is there.
      if (error.empty()) {
        EXPECT_EQ(events_.size(), 60U) << at - begin;
      } else {
        EXPECT_TRUE(has(error, "chunk 2 of ")) << error;
      }
    }
    std::string overwritten = whole;
    overwritten.replace(begin, end - begin, end - begin, '\0');
    EXPECT_TRUE(has(errorOf(overwritten), "chunk 2 of ")) << errorOf(overwritten);
  }
}

TEST_F(PackedBagsTest, ACompressedChunkMustHoldWhatTheIndexSays) {
  rules_.type_fields.clear();
  Parts other = parts_;
  other.messages[1].first += 5;
  for (const bool same : {true, false}) {
    std::string data = (same ? parts_ : other).chunk();
    const auto size = static_cast<std::uint32_t>(data.size());
    std::string lz4(1000 + 2 * data.size(), '\0');
    auto lz4_size = static_cast<unsigned int>(lz4.size());
    ASSERT_EQ(roslz4_buffToBuffCompress(&data[0], size, &lz4[0], &lz4_size, 6), ROSLZ4_OK);
    parts_.compression = "lz4";
    const std::string error = errorOf(
        parts_.bag({parts_.chunkRecord(lz4.substr(0, lz4_size), size) + parts_.indexRecord()}));
    EXPECT_EQ(error.empty(), same) << error;
    EXPECT_TRUE(same || has(error, "contradict each other")) << error;
  }
}

TEST_F(BadBagsTest, AnUnknownCompressionIsRefused) {
  rules_.type_fields.clear();
  parts_.compression = "zip\x1B[2J";
  const std::string error = errorOf(parts_.bag());
  EXPECT_TRUE(has(error, "chunk 1 of 1") && has(error, "unknown compression 'zip")) << error;
  EXPECT_FALSE(has(error, "\x1B"));
}

/// A bag whose chunk begins with a connection, which the index at its end may contradict.
class ConnectionsTest : public BadBagsTest {
 protected:
  std::string bag(const Parts& in_chunk, const std::vector<Parts>& at_end) {
    rules_.type_fields.clear();
    return parts_.bag({parts_.indexedChunk(in_chunk.connectionRecord())}, at_end);
  }
};

TEST_F(ConnectionsTest, AConnectionStaysWhatItWas) {
  EXPECT_EQ(errorOf(bag(parts_, {parts_})), "");
  EXPECT_EQ(errorOf(bag(parts_, {parts_, parts_})), "") << "the same again says nothing else";
  const auto changed = [this](std::string Parts::*part, const std::string& text) {
    Parts other = parts_;
    other.*part = text;
    return other;
  };
  for (const Parts& other :
       {changed(&Parts::topic, "/b"), changed(&Parts::datatype, "std_msgs/Header"),
        changed(&Parts::definition, "string other\n"), changed(&Parts::callerid, "/other")}) {
    const std::string in_chunk = errorOf(bag(other, {parts_}));
    EXPECT_TRUE(has(in_chunk, "chunk 1 of 1") && has(in_chunk, "the connection 0")) << in_chunk;
    const std::string at_end = errorOf(bag(parts_, {parts_, other}));
    EXPECT_TRUE(has(at_end, "the connection 0") && has(at_end, "twice")) << at_end;
  }
}

TEST_F(ConnectionsTest, TheTopicOfAConnectionIsThatOfItsData) {
  EXPECT_EQ(errorOf(bag(parts_, {parts_})), "");
  const auto named = [this](const std::string& header, const std::string& data) {
    parts_.topic = header;
    parts_.topic_of_data = data;
    return errorOf(bag(parts_, {parts_}));
  };
  const std::string error = named("/a", "/b");
  EXPECT_TRUE(has(error, "'/a'") && has(error, "'/b'")) << error;
  // As `rosbag record` does with relative names, also in a namespace.
  EXPECT_EQ(named("scan", "/scan"), "");
  EXPECT_EQ(named("scan", "/robot/scan"), "");
  EXPECT_EQ(named("//scan", "/scan"), "");
  EXPECT_EQ(named("/ns//scan", "/ns/scan"), "");
  EXPECT_EQ(named("scan", "/robot//scan"), "");
  EXPECT_NE(named("scan", "/robotscan"), "");
  EXPECT_NE(named("//scan", "/robot/scan"), "");
  EXPECT_NE(named("/scan", "/robot/scan"), "");
}

}  // namespace
}  // namespace self_awareness::ros1
