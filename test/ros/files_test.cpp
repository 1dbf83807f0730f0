// Bags and model files, good and bad.

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>
#include <visualization_msgs/Marker.h>

#include <boost/filesystem.hpp>
#include <boost/make_shared.hpp>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "self_awareness/core/vocabulary.h"
#include "self_awareness/ros/bag_reader.h"
#include "self_awareness/ros/model_file.h"

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

class FilesTest : public testing::Test {
 protected:
  FilesTest() : folder_(fs::temp_directory_path() / fs::unique_path("self_awareness-%%%%%%%%")) {
    fs::create_directory(folder_);
  }
  ~FilesTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // Ten seconds of two nodes, 10 Hz and 1 Hz, and a latching one.
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

  static std::string bagError(const std::string& bag) {
    try {
      BagReader reader(bag);
    } catch (const BagError& error) {
      return error.what();
    }
    return "";
  }
  static std::string modelError(const std::string& file) {
    try {
      loadModel(file);
    } catch (const ModelFileError& error) {
      return error.what();
    }
    return "";
  }

  static TrainedModel someModel() {
    TrainedModel model;
    model.encoding = EncodingRules::defaults();
    model.statistics = core::DelayStatistics(core::Binning{5000000, 20});
    const core::EventId a = model.statistics.intern({"/a", "/x", "T"});
    const core::EventId b = model.statistics.intern({"/b", "/y", "T[action=1]"});
    core::DelayTrainer trainer(model.statistics);
    for (int i = 0; i < 50; ++i) {
      trainer.add({i * 37000000LL, i % 3 == 0 ? b : a});
    }
    model.stamp = ros::Time(1700000000, 0);
    self_awareness::Recording recording;
    recording.bag = "normal.bag";
    recording.events = 50;
    recording.fingerprint = 0xfedcba9876543210;
    model.recordings = {recording};
    return model;
  }

  // A model message that was changed after it was made.
  template <typename Change>
  std::string damagedModel(Change change) {
    self_awareness::Model message = toMessage(someModel());
    change(message);
    rosbag::Bag bag(path("damaged"), rosbag::bagmode::Write);
    bag.write("/model", ros::Time(1, 0), message);
    bag.close();
    return modelError(path("damaged"));
  }

  fs::path folder_;
  EncodingRules rules_;
  core::Vocabulary vocabulary_;
};

TEST_F(FilesTest, EventsComeInOrderWithoutTheLatchedFirstMessage) {
  const std::vector<core::Event> events = read(writeBag("a.bag"));
  ASSERT_EQ(events.size(), 111U);  // 100 + 10 + the second of the latching one
  EXPECT_EQ(events.front().stamp, 100 * core::kNanosecondsPerSecond);
  for (std::size_t i = 1; i < events.size(); ++i) {
    EXPECT_GE(events[i].stamp, events[i - 1].stamp);
  }
}

TEST_F(FilesTest, EqualStampsKeepTheOrderOfTheRecording) {
  std_msgs::String message;
  rosbag::Bag bag(path("equal.bag"), rosbag::bagmode::Write);
  const auto node = header("/node");
  std::string order;
  for (int round = 1; round < 20; ++round) {
    // Each topic is first, last and between at times.
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

TEST_F(FilesTest, TheSummaryNamesTheRecordingHoweverItIsCompressed) {
  const BagSummary plain = BagReader(writeBag("plain.bag")).summary();
  EXPECT_EQ(plain.messages, 112U);
  EXPECT_EQ(plain.start, 100 * core::kNanosecondsPerSecond);
  EXPECT_EQ(plain.end, 109900 * (core::kNanosecondsPerSecond / 1000));
  EXPECT_TRUE(plain.has_sources);
  for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const BagSummary packed = BagReader(writeBag("packed.bag", compression)).summary();
    EXPECT_EQ(packed.fingerprint, plain.fingerprint);
  }
  EXPECT_EQ(read(path("packed.bag")).size(), 111U);
}

TEST_F(FilesTest, NoMessageIsReadUnlessItsContentIsNeeded) {
  const std::string bag = writeBag("a.bag", rosbag::compression::BZ2);
  // What cannot be unpacked cannot have been read.
  std::fstream file(bag, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(0, std::ios::beg);
  std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::size_t compressed = bytes.find("BZh");
  ASSERT_NE(compressed, std::string::npos);
  file.clear();
  file.seekp(static_cast<std::streamoff>(compressed + 20));
  file.write("\0\0\0\0\0\0\0\0", 8);
  file.close();
  EXPECT_EQ(read(bag).size(), 111U);
  rules_.type_fields = {{"std_msgs/String", "data"}};
  EXPECT_THROW(read(bag), BagError);
}

TEST_F(FilesTest, ContentIsReadWhereTheEncodingNamesAField) {
  rules_.type_fields = {{"std_msgs/String", "data"}};
  const std::vector<core::Event> events = read(writeBag("a.bag", rosbag::compression::LZ4));
  EXPECT_EQ(vocabulary_.at(events.front().id).type,
            "std_msgs/String[data=" + std::string(64, 'x') + "]");
  rules_.type_fields = {{"std_msgs/String", "verb"}};
  EXPECT_THROW(read(path("a.bag")), std::invalid_argument);
}

TEST_F(FilesTest, ARangeCutsTheRecording) {
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

TEST_F(FilesTest, SaysWhatIsWrongWithABag) {
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

TEST_F(FilesTest, EveryTruncatedBagIsRefusedWithTheMend) {
  const std::string bag = writeBag("a.bag");
  const auto size = fs::file_size(bag);
  for (const double share : {0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.999}) {
    fs::copy_file(bag, path("cut.bag"), fs::copy_option::overwrite_if_exists);
    fs::resize_file(path("cut.bag"),
                    static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    const std::string error = bagError(path("cut.bag"));
    EXPECT_NE(error.find("rosbag reindex '" + path("cut.bag") + "'"), std::string::npos)
        << share << ": " << error;
  }
}

TEST_F(FilesTest, ABagThatIsStillBeingWrittenIsRefused) {
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

TEST_F(FilesTest, AModelComesBackAsItWasSaved) {
  TrainedModel model = someModel();
  saveModel(model, path("m"));
  TrainedModel loaded = loadModel(path("m"));
  EXPECT_TRUE(loaded.statistics == model.statistics);
  EXPECT_TRUE(loaded.encoding == model.encoding);
  EXPECT_EQ(loaded.window, model.window);
  EXPECT_EQ(loaded.stamp, model.stamp);
  EXPECT_FALSE(loaded.threshold());
  ASSERT_EQ(loaded.recordings.size(), 1U);
  EXPECT_EQ(loaded.recordings[0].fingerprint, model.recordings[0].fingerprint);

  loaded.calibration = self_awareness::Calibration();
  loaded.calibration->threshold = 1.25;
  loaded.calibration->method = "youden";
  saveModel(loaded, path("m"));
  EXPECT_EQ(loadModel(path("m")).threshold(), 1.25);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(FilesTest, AModelThatCannotBeWrittenLeavesNothingBehind) {
  EXPECT_THROW(saveModel(someModel(), path("no/such/folder/m")), ModelFileError);
  fs::create_directory(path("taken"));
  EXPECT_THROW(saveModel(someModel(), path("taken")), ModelFileError);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(FilesTest, SaysWhatIsWrongWithAModelFile) {
  EXPECT_NE(modelError(path("absent")).find("no such file"), std::string::npos);
  EXPECT_NE(modelError(writeBag("a.bag")).find("holds no model"), std::string::npos);
  std::ofstream(path("text")) << "no model";
  EXPECT_NE(modelError(path("text")).find("not a model file"), std::string::npos);
  saveModel(someModel(), path("cut"));
  fs::resize_file(path("cut"), fs::file_size(path("cut")) / 2);
  EXPECT_NE(modelError(path("cut")).find(path("cut")), std::string::npos);
}

TEST_F(FilesTest, AModelOfAnotherVersionIsRefused) {
  // The md5 as another version of the package would have it.
  saveModel(someModel(), path("m"));
  std::ifstream in(path("m"), std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::string md5 = ros::message_traits::md5sum<self_awareness::Model>();
  std::size_t replaced = 0;
  for (std::size_t at = bytes.find(md5); at != std::string::npos; at = bytes.find(md5, at + 1)) {
    bytes.replace(at, md5.size(), "0123456789abcdef0123456789abcdef");
    ++replaced;
  }
  ASSERT_GT(replaced, 0U);
  std::ofstream(path("m"), std::ios::binary) << bytes;
  EXPECT_NE(modelError(path("m")).find("another version"), std::string::npos)
      << modelError(path("m"));
}

TEST_F(FilesTest, ADamagedModelIsRefused) {
  EXPECT_EQ(damagedModel([](self_awareness::Model& /*model*/) {}), "");
  using Message = self_awareness::Model;
  EXPECT_NE(damagedModel([](Message& m) { m.offsets.pop_back(); }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.bins.pop_back(); }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.offsets[1] = 1000000; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.counts[0] = 0; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.bins[0] = -1; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.bin_size = 0; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.window = ros::Duration(0); }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.window = ros::Duration(-1); }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.event_types[1] = m.event_types[0]; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.event_types.clear(); }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.encoding.source = "colour"; }), "");
  EXPECT_NE(damagedModel([](Message& m) { m.encoding.exclude_topics = {"("}; }), "");
  EXPECT_NE(damagedModel([](Message& m) {
              m.calibration.resize(1);
              m.calibration[0].threshold = std::nan("");
            }),
            "");
}

}  // namespace
}  // namespace self_awareness::ros1
