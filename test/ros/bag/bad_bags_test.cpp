// Bags that were damaged, or made to do harm: each is read, or refused in words that name the
// file.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <boost/filesystem.hpp>
#include <string>
#include <vector>

#include "bad_bags_case.h"

namespace self_awareness::ros1 {
namespace {

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

TEST_F(BadBagsTest, TheBagThatTheOthersAreMadeFromIsGood) {
  EXPECT_EQ(errorOf(parts_.bag()), "");
  EXPECT_EQ(events_.size(), 3U);
  EXPECT_EQ(errorOf(threeChunks()), "");
  EXPECT_EQ(events_.size(), 9U);
  EXPECT_EQ(errorOfLog(eventLog()), "");
  EXPECT_EQ(events_.size(), 3U);
}

TEST_F(BadBagsTest, ABagIsRefusedWhereverItIsCutWithTheRepair) {
  const MemoryLimit limit;
  const std::string bag = threeChunks();
  const std::string log = eventLog();
  for (const std::string* whole : {&bag, &log}) {
    for (const std::size_t boundary : bag_bytes::boundaries(*whole)) {
      for (const int beside : {-1, 0, 1, 5}) {
        const auto cut = static_cast<std::ptrdiff_t>(boundary) + beside;
        if (cut < static_cast<std::ptrdiff_t>(whole->size())) {
          const std::string part = whole->substr(0, static_cast<std::size_t>(cut));
          EXPECT_TRUE(has(whole == &bag ? errorOf(part) : errorOfLog(part), "rosbag reindex '"))
              << cut;
        }
      }
    }
  }
}

TEST_F(BadBagsTest, NoFlippedBitIsBelievedInSilence) {
  const MemoryLimit limit;
  const std::string whole = threeChunks();
  errorOf(whole);
  const std::vector<core::Event> events = events_;
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
  const std::string bag = threeChunks();
  const std::string log = eventLog();
  std::size_t refused = 0;
  for (const std::string* whole : {&bag, &log}) {
    for (std::size_t at = 13; at + 4 < whole->size(); ++at) {
      std::uint32_t length = 0;
      std::memcpy(&length, &(*whole)[at], sizeof length);
      if (length > 5000 || (at > 200 && at < 4000)) {
        continue;  // no length, or the blanks after the file's header
      }
      for (const std::uint32_t lie : {0xFFFFFFFFU, 0x3FFFFFFFU, length ^ 1U}) {
        std::string bytes = *whole;
        bytes.replace(at, sizeof lie, bytesOf(lie));
        const std::string error = whole == &bag ? errorOf(bytes) : errorOfLog(bytes);
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
  EXPECT_EQ(errorOfLog(eventLog()), "") << "to the last second";
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

}  // namespace
}  // namespace self_awareness::ros1
