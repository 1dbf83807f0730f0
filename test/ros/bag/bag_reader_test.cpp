// Tests the reader on good and on bad bags.

#include "self_awareness/ros/bag/bag_reader.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>
#include <visualization_msgs/Marker.h>

#include <boost/filesystem.hpp>
#include <boost/make_shared.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bag_bytes.h"
#include "self_awareness/core/stream/vocabulary.h"

namespace self_awareness::ros1 {
namespace {

namespace fs = boost::filesystem;

boost::shared_ptr<ros::M_string> header(const std::string& callerid, bool latching = false) {
  auto fields = boost::make_shared<ros::M_string>();
  (*fields)["callerid"] = callerid;
  (*fields)["latching"] = latching ? "1" : "0";
  (*fields)["type"] = ros::message_traits::datatype<std_msgs::String>();
  (*fields)["md5sum"] = ros::message_traits::md5sum<std_msgs::String>();
  (*fields)["message_definition"] = ros::message_traits::definition<std_msgs::String>();
  return fields;
}

class BagReaderTest : public testing::Test {
 protected:
  BagReaderTest()
      : folder_(fs::temp_directory_path() / fs::unique_path("self_awareness-%%%%%%%%")) {
    fs::create_directory(folder_);
  }
  ~BagReaderTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // Writes ten seconds of two nodes, at 10 Hz and 1 Hz, and of a latching one.
  std::string writeBag(const std::string& name,
                       rosbag::CompressionType compression = rosbag::compression::Uncompressed) {
    rosbag::Bag bag(path(name), rosbag::bagmode::Write);
    bag.setCompression(compression);
    std_msgs::String message;
    message.data = std::string(1000, 'x');
    const auto fast = header("/fast");
    const auto slow = header("/slow");
    const auto latched = header("/latched", true);
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
    try {
      BagReader reader(bag);
    } catch (const BagError& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
  EncodingRules rules_;
  core::Vocabulary vocabulary_;
};

TEST_F(BagReaderTest, EventsComeInOrderWithoutTheLatchedFirstMessage) {
  const std::vector<core::Event> events = read(writeBag("a.bag"));
  ASSERT_EQ(events.size(), 111U);  // 100 + 10 + the second of the latching one
  EXPECT_EQ(events.front().stamp, 100 * core::kNanosecondsPerSecond);
  for (std::size_t i = 1; i < events.size(); ++i) {
    EXPECT_GE(events[i].stamp, events[i - 1].stamp);
  }
}

TEST_F(BagReaderTest, TheLatchedFirstMessageTellsTheMode) {
  rules_.mode = ModeField{"/state", "data"};
  const std::string bag = writeBag("a.bag");
  std::vector<core::Event> modes;
  std::size_t others = 0;
  for (const core::Event& event : read(bag)) {
    if (vocabulary_.tellsMode(event.id)) {
      modes.push_back(event);
    } else {
      ++others;
    }
  }
  EXPECT_EQ(others, 111U) << "nothing else changes";
  ASSERT_EQ(modes.size(), 2U);
  EXPECT_LT(modes[0].stamp, modes[1].stamp);
  EXPECT_EQ(modes[1].stamp, 105 * core::kNanosecondsPerSecond);
  EXPECT_EQ(vocabulary_.at(modes[0].id).scope, "/state");
}

TEST_F(BagReaderTest, NamesAreWholeHoweverTheyWereTyped) {
  // `rosbag record a //b ns//c`, some of it twice; the publisher says the whole name of the topic.
  rosbag::Bag bag(path("typed.bag"), rosbag::bagmode::Write);
  double time = 100;
  for (const auto& [typed, whole] : std::vector<std::pair<std::string, std::string>>{
           {"a", "/a"}, {"/a", "/a"}, {"//b", "/b"}, {"ns//c", "/robot/ns/c"}, {"d", ""}}) {
    for (const char* caller : {"/node", "node", "//node"}) {
      const auto fields = header(caller);
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
  const auto node = header("/node");
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

TEST_F(BagReaderTest, TheSummaryNamesTheRecordingHoweverItIsCompressed) {
  const BagSummary plain = BagReader(writeBag("plain.bag")).summary();
  EXPECT_EQ(plain.messages, 112U);
  EXPECT_EQ(plain.start, 100 * core::kNanosecondsPerSecond);
  EXPECT_EQ(plain.end, 109900 * (core::kNanosecondsPerSecond / 1000));
  EXPECT_TRUE(plain.has_sources);
  EXPECT_FALSE(plain.one_sender_a_topic) << "rosbag record keeps them all";
  EXPECT_FALSE(plain.copied);
  for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const BagSummary packed = BagReader(writeBag("packed.bag", compression)).summary();
    EXPECT_EQ(packed.fingerprint, plain.fingerprint);
  }
  EXPECT_EQ(read(path("packed.bag")).size(), 111U);
}

TEST_F(BagReaderTest, TheSummaryIsTheSameAfterAnotherProgramWroteTheBagAgain) {
  const auto fingerprint = [this](const std::vector<std::pair<std::string, int>>& messages) {
    rosbag::Bag bag(path("again.bag"), rosbag::bagmode::Write);
    for (const auto& [topic, second] : messages) {
      bag.write(topic, ros::Time(second, 0), std_msgs::String(), header("/node"));
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
    bag.write("/a", ros::Time(100 + i * 7 % kMessages, 0), message, header("/node"));
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
  auto image_header = header("/camera");
  (*image_header)["type"] = "test/Image";  // nothing reads its content
  for (int i = 1; i <= 5000; ++i) {
    const ros::Time stamp = ros::Time(100, 0) + ros::Duration(0.01 * i);
    bag.write("/small", stamp, small, header("/node"));
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
                header("/node"));
    }
  }
  bag.close();
  const std::uint64_t before = bytesRead();
  EXPECT_EQ(read(path("turns.bag")).size(), static_cast<std::size_t>(kChunks * kOfEach));
  EXPECT_LT(static_cast<double>(bytesRead() - before),
            4 * static_cast<double>(fs::file_size(path("turns.bag"))));
}

TEST_F(BagReaderTest, ABagOfTheFormerFormatIsLeftToRosbag) {
  const std::string bag = path("former.bag");
  bag_bytes::writeFile(bag, bag_bytes::formerBag());
  const BagSummary summary = BagReader(bag).summary();
  EXPECT_EQ(summary.messages, 3U);
  EXPECT_EQ(summary.start, 100 * core::kNanosecondsPerSecond);
  EXPECT_FALSE(summary.has_sources);
  rules_.source = EncodingRules::Source::kNone;
  rules_.type_fields = {{"std_msgs/String", "data"}};
  std::string seen;
  for (const core::Event& event : read(bag)) {
    seen += toString(vocabulary_.at(event.id)) + '\n';
  }
  EXPECT_EQ(seen,
            "- /a std_msgs/String[data=x]\n- /a std_msgs/String[data=y]\n"
            "- /a std_msgs/String[data=z]\n");
}

TEST_F(BagReaderTest, ContentIsReadWhereTheEncodingNamesAField) {
  rules_.type_fields = {{"std_msgs/String", "data"}};
  const std::vector<core::Event> events = read(writeBag("a.bag", rosbag::compression::LZ4));
  EXPECT_EQ(vocabulary_.at(events.front().id).type,
            "std_msgs/String[data=" + std::string(64, 'x') + "]");
  rules_.type_fields = {{"std_msgs/String", "verb"}};
  EXPECT_THROW(read(path("a.bag")), std::invalid_argument);
}

TEST_F(BagReaderTest, ARangeCutsTheRecording) {
  const std::string bag = writeBag("a.bag");
  TimeRange range;
  range.start = 2.0;
  range.end = 3.0;
  EXPECT_EQ(read(bag, range).size(), 11U + 2U);  // both ends included
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
  EXPECT_NE(bagError(folder_.string()).find("not a file"), std::string::npos);

  std::ofstream(path("empty.bag")).close();
  EXPECT_NE(bagError(path("empty.bag")).find("not a bag"), std::string::npos);
  std::ofstream(path("text.bag")) << "This is no bag but text that goes on for quite a while.\n";
  EXPECT_NE(bagError(path("text.bag")).find(path("text.bag") + ": not a bag"), std::string::npos)
      << bagError(path("text.bag"));

  rosbag::Bag(path("none.bag"), rosbag::bagmode::Write).close();
  EXPECT_NE(bagError(path("none.bag")).find("holds no messages"), std::string::npos)
      << bagError(path("none.bag"));
}

TEST_F(BagReaderTest, EveryTruncatedBagIsRefusedWithTheRepair) {
  const std::string bag = writeBag("a.bag");
  const auto size = fs::file_size(bag);
  for (const double share : {0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.999}) {
    fs::remove(path("cut.bag"));
    fs::copy_file(bag, path("cut.bag"));
    fs::resize_file(path("cut.bag"),
                    static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    const std::string error = bagError(path("cut.bag"));
    EXPECT_NE(error.find("rosbag reindex '" + path("cut.bag") + "'"), std::string::npos)
        << share << ": " << error;
  }
}

TEST_F(BagReaderTest, ADamagedBagIsReadOrRefused) {
  std::ifstream file(writeBag("a.bag", rosbag::compression::LZ4), std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)),
                          std::istreambuf_iterator<char>());
  rules_.type_fields = {{"std_msgs/String", "data"}};
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string damaged = bytes;
    char& byte = damaged[random() % damaged.size()];
    byte = static_cast<char>(byte ^ (1 << random() % 8));
    std::ofstream(path("damaged.bag"), std::ios::binary) << damaged;
    try {
      read(path("damaged.bag"));
    } catch (const BagError&) {
      ++refused;
    } catch (const std::invalid_argument&) {  // the damage is in the message's definition
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

TEST_F(BagReaderTest, ABagThatIsStillBeingWrittenIsRefused) {
  rosbag::Bag bag(path("b.bag.active"), rosbag::bagmode::Write);
  bag.setChunkThreshold(1000);
  std_msgs::String message;
  message.data = std::string(1000, 'x');
  for (int i = 1; i < 20; ++i) {
    bag.write("/a", ros::Time(i, 0), message);
  }
  EXPECT_NE(bagError(path("b.bag.active")).find("rosbag reindex"), std::string::npos);
  bag.close();
}

}  // namespace
}  // namespace self_awareness::ros1
