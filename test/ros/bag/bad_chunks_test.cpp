// What is in the chunks of a bag is compared with what its index says, compressed or not.

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <roslz4/lz4s.h>
#include <std_msgs/String.h>

#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "bad_bags_case.h"

namespace self_awareness::ros1 {
namespace {

using bag_bytes::Parts;

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
  /// Where the data of the chunks begin and end.
  static std::vector<std::pair<std::size_t, std::size_t>> chunksOf(const std::string& bag) {
    std::vector<std::pair<std::size_t, std::size_t>> chunks;
    const std::vector<std::size_t> begins = bag_bytes::boundaries(bag);
    for (std::size_t k = 0; k + 1 < begins.size(); ++k) {
      std::uint32_t length = 0;
      std::memcpy(&length, &bag[begins[k]], sizeof length);
      const std::size_t data = begins[k] + 2 * sizeof length + length;
      if (bag.substr(begins[k], data - begins[k]).find("compression=") != std::string::npos) {
        chunks.emplace_back(data, begins[k + 1]);
      }
    }
    return chunks;
  }
};

TEST_F(PackedBagsTest, DamageInACompressedChunkIsToldWithTheChunk) {
  rules_.type_fields.clear();  // no message is read for what is in it
  rules_.source = EncodingRules::Source::kNone;
  for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const std::string whole = packed(compression);
    ASSERT_EQ(errorOf(whole), "");
    ASSERT_EQ(events_.size(), 60U);
    const auto chunks = chunksOf(whole);
    ASSERT_GE(chunks.size(), 3U);
    const auto [begin, end] = chunks[1];
    for (std::size_t at = begin; at < end; ++at) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ 1 << at % 8);
      const std::string error = errorOf(bytes);
      // A few bits of a frame mean nothing; then all is there.
      if (error.empty()) {
        EXPECT_EQ(events_.size(), 60U) << at - begin;
      } else {
        EXPECT_TRUE(has(error, "chunk 2 of " + std::to_string(chunks.size()))) << error;
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
