// Tests the reader on good and on bad bags.

#include "self_awareness/ros/bag/bag_reader.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <boost/filesystem.hpp>
#include <cmath>
#include <fstream>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../../in_folder.h"
#include "../../problem.h"
#include "../serialized.h"
#include "bag_bytes.h"
#include "self_awareness/core/stream/vocabulary.h"

namespace self_awareness::ros1 {
namespace {

namespace fs = boost::filesystem;

class BagReaderTest : public InFolder {
 protected:
  // Writes ten seconds of two nodes, at 10 Hz and 1 Hz, and of a latching one.
  std::string writeBag(const std::string& name,
                       rosbag::CompressionType compression = rosbag::compression::Uncompressed) {
    rosbag::Bag bag(path(name), rosbag::bagmode::Write);
    bag.setCompression(compression);
    std_msgs::String message;
    message.data = std::string(1000, 'x');
    const auto fast = headerOf<std_msgs::String>("/fast");
    const auto slow = headerOf<std_msgs::String>("/slow");
    const auto latched = headerOf<std_msgs::String>("/latched", true);
    bag.write("/state", ros::Time(100, 0), message, latched);
    for (int i = 0; i < 100; ++i) {
      const ros::Time stamp = ros::Time(100, 0) + ros::Duration(0.1 * i);
      bag.write("/a", stamp, message, fast);
      if (i % 10 == 0) {
        bag.write("/b", stamp, message, slow);
      }
    }
    bag.write("/state", ros::Time(105, 0), message, latched);
    bag.close();
    return path(name);
  }

  std::vector<core::Event> read(const std::string& bag, const TimeRange& range = {}) {
    std::vector<core::Event> events;
    const Encoder encoder(
        rules_, [this](const core::EventType& type) { return vocabulary_.intern(type); });
    BagReader(bag).read(encoder, range,
                        [&](const core::Event& event) { events.push_back(event); });
    return events;
  }

  // What this process has read so far, from any file [bytes].
  static std::uint64_t bytesRead() {
    std::ifstream io("/proc/self/io");
    std::string name;
    std::uint64_t bytes = 0;
    while (io >> name >> bytes && name != "rchar:") {
    }
    return bytes;
  }

  static std::string bagError(const std::string& bag) {
    return problemOf<BagError>([&] { BagReader reader(bag); });
  }

  EncodingRules rules_;
  core::Vocabulary vocabulary_;
};

TEST_F(BagReaderTest, EventsComeInOrderAndTheLatchedFirstMessageIsOnlyThereAndTellsTheMode) {
  rules_.mode = ModeField{"/state", "data"};
  std::vector<core::Event> modes;
  std::vector<core::Event> others;
  for (const core::Event& event : read(writeBag("a.bag"))) {
    (vocabulary_.tellsMode(event.id) ? modes : others).push_back(event);
  }
  ASSERT_EQ(others.size(), 112U);  // 100 + 10 + both of the latching one
  EXPECT_TRUE(vocabulary_.isLatched(others.front().id));
  EXPECT_EQ(others.front().stamp, 100 * core::kNanosecondsPerSecond);
  for (std::size_t i = 1; i < others.size(); ++i) {
    EXPECT_GE(others[i].stamp, others[i - 1].stamp);
  }
  ASSERT_EQ(modes.size(), 2U);
  EXPECT_LT(modes[0].stamp, modes[1].stamp);
  EXPECT_EQ(modes[1].stamp, 105 * core::kNanosecondsPerSecond);
  EXPECT_EQ(vocabulary_.at(modes[0].id).scope, "/state");
  rules_.mode.reset();
  vocabulary_ = {};
  EXPECT_EQ(read(path("a.bag")).size(), 112U) << "nothing else changes";
}

TEST_F(BagReaderTest, NamesAreWholeHoweverTheyWereTyped) {
  // `rosbag record a //b ns//c`, some of it twice; the publisher says the whole name of the topic.
  rosbag::Bag bag(path("typed.bag"), rosbag::bagmode::Write);
  double time = 100;
  for (const auto& [typed, whole] : std::vector<std::pair<std::string, std::string>>{
           {"a", "/a"}, {"/a", "/a"}, {"//b", "/b"}, {"ns//c", "/robot/ns/c"}, {"d", ""}}) {
    for (const char* caller : {"/node", "node", "//node"}) {
      const auto fields = headerOf<std_msgs::String>(caller);
      if (!whole.empty()) {
        (*fields)["topic"] = whole;
      }
      for (int i = 0; i < 2; ++i) {
        bag.write(typed, ros::Time(time++), std_msgs::String(), fields);
      }
    }
  }
  bag.close();
  EXPECT_EQ(read(path("typed.bag")).size(), 30U);
  std::vector<std::string> scopes;
  for (const core::EventType& type : vocabulary_.types()) {
    EXPECT_EQ(type.source, "/node");
    scopes.push_back(type.scope);
  }
  EXPECT_EQ(scopes, (std::vector<std::string>{"/a", "/b", "/robot/ns/c", "/d"}));
  EXPECT_EQ(eventTypesIn({path("typed.bag")}, Encoder(rules_, nullptr)),
            (std::set<core::EventType>(vocabulary_.types().begin(), vocabulary_.types().end())));
}

TEST_F(BagReaderTest, EqualStampsKeepTheOrderOfTheRecording) {
  std_msgs::String message;
  rosbag::Bag bag(path("equal.bag"), rosbag::bagmode::Write);
  const auto node = headerOf<std_msgs::String>("/node");
  std::string order;
  for (int round = 1; round < 20; ++round) {
    // Each topic is sometimes first, sometimes last, and sometimes between.
    for (int i = 0; i < 3; ++i) {
      const char topic = static_cast<char>('a' + (i * (round % 2 + 1) + round) % 3);
      order += topic;
      bag.write(std::string("/") + topic, ros::Time(round, 0), message, node);
    }
  }
  bag.close();
  std::string seen;
  for (const core::Event& event : read(path("equal.bag"))) {
    seen += vocabulary_.at(event.id).scope.back();
  }
  EXPECT_EQ(seen, order);
}

TEST_F(BagReaderTest, TheSummaryAndEventsAreTheSameHoweverTheBagIsCompressed) {
  const BagSummary plain = BagReader(writeBag("plain.bag")).summary();
  EXPECT_EQ(plain.messages, 112U);
  EXPECT_EQ(plain.start, 100 * core::kNanosecondsPerSecond);
  EXPECT_EQ(plain.end, 109900 * (core::kNanosecondsPerSecond / 1000));
  EXPECT_TRUE(plain.has_sources);
  EXPECT_FALSE(plain.one_sender_a_topic) << "rosbag record keeps them all";
  EXPECT_FALSE(plain.copied);
  const std::vector<core::Event> events = read(path("plain.bag"));
  EXPECT_TRUE(events.back().attributes.isKnown());
  for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const std::vector<core::Event> packed = read(writeBag("packed.bag", compression));
    EXPECT_TRUE(std::equal(packed.begin(), packed.end(), events.begin(), events.end(),
                           [](const core::Event& a, const core::Event& b) {
                             return a.stamp == b.stamp && a.attributes == b.attributes;
                           }));
    EXPECT_EQ(BagReader(path("packed.bag")).summary().fingerprint, plain.fingerprint);
  }
}

TEST_F(BagReaderTest, TheSummaryIsTheSameAfterAnotherProgramWroteTheBagAgain) {
  const auto fingerprint = [this](const std::vector<std::pair<std::string, int>>& messages) {
    rosbag::Bag bag(path("again.bag"), rosbag::bagmode::Write);
    for (const auto& [topic, second] : messages) {
      bag.write(topic, ros::Time(second, 0), std_msgs::String(),
                headerOf<std_msgs::String>("/node"));
    }
    bag.close();
    return BagReader(path("again.bag")).summary().fingerprint;
  };
  const std::uint64_t once = fingerprint({{"/a", 1}, {"/b", 1}, {"/a", 2}});
  EXPECT_EQ(fingerprint({{"/b", 1}, {"/a", 1}, {"/a", 2}}), once);
  EXPECT_NE(fingerprint({{"/a", 1}, {"/b", 2}, {"/a", 2}}), once);
  EXPECT_NE(fingerprint({{"/a", 1}, {"/b", 1}, {"/b", 2}}), once);
  EXPECT_NE(fingerprint({{"/a", 1}, {"/b", 1}}), once);
}

TEST_F(BagReaderTest, ChunksThatOverlapInTimeAreReadInItsOrder) {
  rosbag::Bag bag(path("overlap.bag"), rosbag::bagmode::Write);
  bag.setChunkThreshold(200);
  std_msgs::String message;
  message.data = std::string(100, 'x');
  constexpr int kMessages = 50;
  for (int i = 0; i < kMessages; ++i) {
    bag.write("/a", ros::Time(100 + i * 7 % kMessages, 0), message,
              headerOf<std_msgs::String>("/node"));
  }
  bag.close();
  const std::vector<core::Event> events = read(path("overlap.bag"));
  ASSERT_EQ(events.size(), static_cast<std::size_t>(kMessages));
  for (int i = 0; i < kMessages; ++i) {
    EXPECT_EQ(events[i].stamp, (100 + i) * core::kNanosecondsPerSecond);
  }
}

TEST_F(BagReaderTest, HardlyAnythingIsReadOfABagWithImages) {
  std_msgs::String image;
  image.data = std::string(1000000, 'x');
  std_msgs::String small;
  small.data = "y";
  rosbag::Bag bag(path("images.bag"), rosbag::bagmode::Write);
  auto image_header = headerOf<std_msgs::String>("/camera");
  (*image_header)["type"] = "test/Image";  // nothing reads its content
  for (int i = 1; i <= 5000; ++i) {
    const ros::Time stamp = ros::Time(100, 0) + ros::Duration(0.01 * i);
    bag.write("/small", stamp, small, headerOf<std_msgs::String>("/node"));
    if (i % 100 == 0) {
      bag.write("/image", stamp, image, image_header);
    }
  }
  bag.close();
  rules_.type_fields = {{"std_msgs/String", "data"}};
  const std::uint64_t before = bytesRead();
  EXPECT_EQ(read(path("images.bag")).size(), 5050U);
  const auto read = static_cast<double>(bytesRead() - before);
  EXPECT_GT(read, 5050 * 12);  // the counter works
  EXPECT_LT(read, 0.05 * static_cast<double>(fs::file_size(path("images.bag"))));
}

TEST_F(BagReaderTest, ChunksThatTakeTurnsAreUnpackedOnce) {
  constexpr int kChunks = 3;
  constexpr int kOfEach = 40;
  std::mt19937 random(1);
  rosbag::Bag bag(path("turns.bag"), rosbag::bagmode::Write);
  bag.setCompression(rosbag::compression::LZ4);
  bag.setChunkThreshold(300000);
  for (int chunk = 0; chunk < kChunks; ++chunk) {
    for (int k = 0; k < kOfEach; ++k) {
      std_msgs::String message;
      message.data.resize(10000);
      for (char& c : message.data) {
        c = static_cast<char>(random());
      }
      bag.write("/a", ros::Time(100, 0) + ros::Duration(kChunks * k + chunk), message,
                headerOf<std_msgs::String>("/node"));
    }
  }
  bag.close();
  const std::uint64_t before = bytesRead();
  EXPECT_EQ(read(path("turns.bag")).size(), static_cast<std::size_t>(kChunks * kOfEach));
  EXPECT_LT(static_cast<double>(bytesRead() - before),
            4 * static_cast<double>(fs::file_size(path("turns.bag"))));
}

TEST_F(BagReaderTest, ContentIsReadWhereTheEncodingNamesAField) {
  rules_.type_fields = {{"std_msgs/String", "data"}};
  const std::vector<core::Event> events = read(writeBag("a.bag", rosbag::compression::LZ4));
  EXPECT_EQ(vocabulary_.at(events.back().id).type,
            "std_msgs/String[data=" + std::string(64, 'x') + "]");
  rules_.type_fields = {{"std_msgs/String", "verb"}};
  EXPECT_THROW(read(path("a.bag")), std::invalid_argument);
}

TEST_F(BagReaderTest, ARangeCutsTheRecording) {
  const std::string bag = writeBag("a.bag");
  TimeRange range;
  range.start = 2.0;
  range.end = 3.0;
  const std::vector<core::Event> events = read(bag, range);
  EXPECT_EQ(events.size(), 11U + 2U + 1U);  // both ends included
  EXPECT_TRUE(vocabulary_.isLatched(events.front().id)) << "what was latched before lasts";
  range = {};
  range.start = 60.0;
  EXPECT_THROW(read(bag, range), BagError);
  range.start = -1.0;
  EXPECT_THROW(read(bag, range), std::invalid_argument);
  range.start = std::nan("");
  EXPECT_THROW(read(bag, range), std::invalid_argument);
}

TEST_F(BagReaderTest, SaysWhatIsWrongWithABag) {
  EXPECT_EQ(bagError(path("absent.bag")), path("absent.bag") + ": no such file");
  EXPECT_TRUE(has(bagError(folder_.string()), "not a file"));
}

}  // namespace
}  // namespace self_awareness::ros1
