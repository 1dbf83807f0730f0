// Files of other versions: of older ones they are read, of newer ones if those say so.

#include "self_awareness/ros/file_version.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <topic_tools/shape_shifter.h>

#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/model_file_case.h"
#include "ros/bag/bag_index.h"
#include "ros/bag/version_of_bag.h"
#include "self_awareness/FileVersion.h"
#include "self_awareness/ros/bag/bag_reader.h"
#include "self_awareness/ros/bag/event_log_reader.h"
#include "self_awareness/ros/bag/event_log_writer.h"
#include "self_awareness/ros/model/model_file.h"

namespace self_awareness::ros1 {
namespace {

using self_awareness::FileVersion;
using topic_tools::ShapeShifter;

constexpr std::int64_t kBeginOfLog = 1790000000LL * core::kNanosecondsPerSecond;

/// Definition and bytes of a message as another version of this package would write it.
struct Stored {
  std::string definition;
  std::vector<std::uint8_t> bytes;
};
/// Changes messages by their type; nothing is changed where it does nothing.
using Change = std::function<void(const std::string& datatype, Stored& stored)>;

class FileVersionTest : public ModelFileTest {
 protected:
  std::string model() {
    saveModel(calibratedModel(), path("model"));
    return path("model");
  }

  std::string log() {
    EventLogWriter log(path("log"));
    log.start(startOfRecording(rules_, kBeginOfLog));
    EventLogPacker packer([&](self_awareness::EventLog part) { log.write(std::move(part)); });
    core::Vocabulary vocabulary;
    for (int k = 0; k < 50; ++k) {
      packer.add({kBeginOfLog + k * 1000000LL, vocabulary.intern({"/a", "/x", "T"})}, vocabulary);
    }
    packer.flush(kBeginOfLog + core::kNanosecondsPerSecond);
    log.writeGraph(Graph(), kBeginOfLog);
    log.close();
    return path("log");
  }

  /// A copy as another version would have written it.
  /// @param version what the copy says; none: nothing
  std::string rewritten(
      const std::string& file, const std::optional<FileVersion>& version,
      const Change& change = [](const std::string&, Stored&) {}, bool extra_topic = false) {
    const rosbag::Bag from(file, rosbag::bagmode::Read);
    rosbag::Bag to(path("rewritten"), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(from)) {
      if (message.getTopic() == kVersionTopic) {
        if (version) {
          to.write(kVersionTopic, message.getTime(), *version);
        }
        continue;
      }
      if (message.getTopic() == "/digest") {
        continue;  // of what it was
      }
      Stored stored{message.getMessageDefinition(), {}};
      stored.bytes.resize(message.size());
      ros::serialization::OStream stream(stored.bytes.data(), message.size());
      message.write(stream);
      change(message.getDataType(), stored);
      const bool changed = stored.definition != message.getMessageDefinition();
      ShapeShifter shape;
      shape.morph(changed ? "0123456789abcdef0123456789abcdef" : message.getMD5Sum(),
                  message.getDataType(), stored.definition, "0");
      ros::serialization::IStream bytes(stored.bytes.data(),
                                        static_cast<std::uint32_t>(stored.bytes.size()));
      shape.read(bytes);
      to.write(message.getTopic(), message.getTime(), shape);
      if (extra_topic) {
        to.write("/what/is/this", message.getTime(), std_msgs::String());
      }
    }
    to.close();
    return path("rewritten");
  }

  static FileVersion newer(const FileKind& kind, std::uint32_t oldest_reader) {
    FileVersion version = versionOf(kind);
    version.format = kind.format + 3;
    version.oldest_reader = oldest_reader;
    version.package = "7.8.9";
    return version;
  }

  EncodingRules rules_ = EncodingRules::defaults();
};

/// A field that only a newer version knows, at the end of a message.
void addField(Stored& stored) {
  const std::size_t end = std::min(stored.definition.find("====="), stored.definition.size());
  stored.definition.insert(end, "\nstring newer\n");
  stored.bytes.insert(stored.bytes.end(), {3, 0, 0, 0, 'n', 'e', 'w'});
}

TEST_F(FileVersionTest, EachFileBeginsWithItsVersion) {
  for (const auto& [file, kind] : {std::pair{model(), kModelFile}, {log(), kEventLogFile}}) {
    EXPECT_EQ(readBagConnections(file).front().topic, kVersionTopic);
    const rosbag::Bag bag(file, rosbag::bagmode::Read);
    rosbag::View view(bag, rosbag::TopicQuery(kVersionTopic));
    ASSERT_EQ(view.size(), 1U) << file;
    const auto version = view.begin()->instantiate<FileVersion>();
    ASSERT_TRUE(version) << file;
    EXPECT_EQ(*version, versionOf(kind));
    EXPECT_GE(version->format, 2U);
    EXPECT_FALSE(version->package.empty());
    EXPECT_EQ(readFileVersion(file, kind), versionOf(kind));
  }
  EXPECT_EQ(loadModel(model()).version, versionOf(kModelFile));
}

TEST_F(FileVersionTest, AModelOfAFormatOfNoReleaseIsRefusedWithTheWayOut) {
  FileVersion former = versionOf(kModelFile);
  former.format = kModelFile.first - 1;
  former.oldest_reader = former.format;
  EXPECT_EQ(readFileVersion(rewritten(model(), std::nullopt), kModelFile).format, 1U);
  for (const std::optional<FileVersion>& version : {std::optional(former), {std::nullopt}}) {
    const std::string error = modelError(rewritten(model(), version));
    EXPECT_EQ(error, path("rewritten") + ": of format " + (version ? "7" : "1") +
                         ", which was of no release and is not read any more (format 8 is the "
                         "first one); train it again (rosrun self_awareness train)");
  }
}

TEST_F(FileVersionTest, AFileThatNeedsANewerReaderIsRefusedInOneLine) {
  const std::uint32_t needed = kModelFile.format + 1;
  const std::string error = modelError(rewritten(model(), newer(kModelFile, needed)));
  for (const std::string& part :
       {path("rewritten") + ": written by a newer self_awareness (7.8.9, format ",
        "readers of format " + std::to_string(needed), versionOf(kModelFile).package,
        std::string("update self_awareness")}) {
    EXPECT_TRUE(has(error, part));
  }
  EXPECT_FALSE(has(error, "\n"));
  FileVersion strange = newer(kModelFile, needed);
  strange.package = "\x1b[2J" + std::string(5000, 'x');
  const std::string damaged = modelError(rewritten(model(), strange));
  EXPECT_TRUE(damaged.size() < 400 && !has(damaged, "\x1b")) << damaged;

  const std::string new_log = rewritten(log(), newer(kEventLogFile, kEventLogFile.format + 1));
  EXPECT_TRUE(begins(problemOf<BagError>([&] { EventLogReader(new_log, 0); }),
                     new_log + ": written by a newer self_awareness"));
  EXPECT_EQ(recordingsInEventLog(new_log), 1U) << "it is not taken for an ordinary bag";
  EXPECT_THROW(BagReader{new_log}, BagError);
  EXPECT_EQ(readFileVersion(new_log, kEventLogFile).package, "7.8.9");
}

TEST_F(FileVersionTest, AFileOfANewerFormatIsReadIfItSaysSo) {
  const std::string file = rewritten(
      model(), newer(kModelFile, kModelFile.format),
      [](const std::string& /*type*/, Stored& stored) {
        addField(stored);
        if (stored.definition.find("\nuint8[] bytes") != std::string::npos) {  // one more in it
          std::uint32_t length = 0;
          std::memcpy(&length, stored.bytes.data(), sizeof length);
          stored.bytes.insert(stored.bytes.begin() + sizeof length + length++, 42);
          std::memcpy(stored.bytes.data(), &length, sizeof length);
        }
      },
      true);
  ASSERT_EQ(modelError(file), "");
  TrainedModel loaded = loadModel(file);
  EXPECT_EQ(loaded.version.format, kModelFile.format + 3);
  loaded.version = versionOf(kModelFile);
  EXPECT_EQ(toBytes(loaded), toBytes(loadModel(model())));

  const std::string new_log = rewritten(
      log(), newer(kEventLogFile, kEventLogFile.format),
      [](const std::string& /*type*/, Stored& stored) { addField(stored); }, true);
  EXPECT_EQ(recordingsInEventLog(new_log), 1U);
  std::size_t events = 0;
  EventLogReader(new_log, 0)
      .read(
          rules_, [](const core::EventType& /*type*/) { return 0; }, {},
          [&](const core::Event& /*event*/) { ++events; });
  EXPECT_EQ(events, 50U);
  EXPECT_EQ(readFileVersion(new_log, kEventLogFile).format, kEventLogFile.format + 3);
}

TEST_F(FileVersionTest, ABagInWhichSomebodyRecordedALogsTopicsIsNoLog) {
  const std::string file = rewritten(
      log(), versionOf(kEventLogFile), [](const std::string&, Stored&) {}, true);
  EXPECT_FALSE(recordingsInEventLog(file));
  EXPECT_NO_THROW(BagReader{file});
}

TEST_F(FileVersionTest, AFileOfAnotherKindIsNamed) {
  EXPECT_TRUE(has(modelError(log()), "event log"));
  EXPECT_FALSE(recordingsInEventLog(model()));
  EXPECT_THROW(readFileVersion(model(), kEventLogFile), BagError);
}

TEST_F(FileVersionTest, AModelKeepsTheMethodOfItsCounts) {
  TrainedModel model = calibratedModel();
  model.version.method = 77;
  saveModel(model, path("old"));
  EXPECT_EQ(loadModel(path("old")).version.method, 77U);
  EXPECT_EQ(loadModel(path("old")).version.format, kModelFile.format);
  EXPECT_EQ(fromBytes(toBytes(model)).version.method, 77U);
}

}  // namespace
}  // namespace self_awareness::ros1
