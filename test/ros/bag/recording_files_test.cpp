// Tests that the bags of one recording are read as one, and what is said of a file without reading
// all of it.

#include "ros/bag/recording_files.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/Header.h>

#include <boost/filesystem.hpp>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../../in_folder.h"
#include "../../problem.h"
#include "../serialized.h"
#include "ros/bag/open_bag.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/ros/bag/bag_reader.h"

namespace self_awareness::ros1 {
namespace {

namespace fs = boost::filesystem;

using Said = std::tuple<std::int64_t, core::EventType, std::uint32_t>;

class RecordingFilesTest : public InFolder {
 protected:
  /// What the recorder repeats at the beginning of a file, and how.
  enum class Repeated { kNothing, kWithoutSender, kWithSender };

  /// Writes what came from `begin` to `end`, in tenths of a second: a message each, and a map that
  /// is latched, at 0.1 s and at 7 s. /slow connects first in every other file.
  std::string write(const std::string& name, int begin, int end,
                    Repeated repeated = Repeated::kNothing) {
    rosbag::Bag bag(path(name), rosbag::bagmode::Write);
    const auto fast = headerOf<std_msgs::Header>("/fast");
    const auto slow = headerOf<std_msgs::Header>("/slow");
    const auto latched = headerOf<std_msgs::Header>("/maps", true);
    if (repeated == Repeated::kWithSender) {
      bag.write("/map", stamp(begin), map(begin), latched);
    } else if (repeated == Repeated::kWithoutSender) {
      bag.write("/map", stamp(begin), map(begin));  // as rosbag record --repeat-latched does
    }
    for (int i = begin; i < end; ++i) {
      std_msgs::Header message;
      message.seq = static_cast<std::uint32_t>(i);
      message.frame_id = i / 3 % 2 == 0 ? "even" : "odd";
      if (i % 7 == begin % 2) {
        bag.write("/b", stamp(i), message, slow);
      }
      bag.write("/a", stamp(i), message, fast);
      if (i == 1 || i == 70) {
        bag.write("/map", stamp(i), map(i + 1), latched);
      }
    }
    bag.close();
    return path(name);
  }

  static ros::Time stamp(int tenths) { return ros::Time(100, 0) + ros::Duration(0.1 * tenths); }
  /// What was latched before a time.
  static std_msgs::Header map(int tenths) {
    std_msgs::Header message;
    message.frame_id = tenths <= 70 ? "first" : "second";
    return message;
  }

  static std::vector<Said> read(const std::vector<std::string>& paths) {
    core::Vocabulary vocabulary;
    const EncodingRules rules;
    const Encoder encoder(rules,
                          [&](const core::EventType& type) { return vocabulary.intern(type); });
    std::vector<Said> said;
    BagReader(paths).read(encoder, {}, [&](const core::Event& event) {
      said.emplace_back(event.stamp, vocabulary.types()[event.id], core::packed(event.attributes));
    });
    return said;
  }

  static std::string errorOf(const std::string& bag) {
    return problemOf<BagError>([&] { spanOfBag(bag); });
  }
};

TEST_F(RecordingFilesTest, FilesAreReadAsTheOneBagThatTheyWere) {
  const std::vector<std::string> files{write("run_0.bag", 0, 40), write("run_1.bag", 40, 80),
                                       write("run_2.bag", 80, 120)};
  EXPECT_EQ(nameOf(files), path("run_0.bag") + "..2");
  const BagSummary split = BagReader(files).summary();
  EXPECT_EQ(split.bag, "run_0.bag..2");
  EXPECT_EQ(split.end - split.start, 119 * core::kNanosecondsPerSecond / 10);
  ASSERT_EQ(split.files.size(), 3U);
  EXPECT_EQ(split.files[1].path, files[1]);
  EXPECT_EQ(split.files[1].start - split.start, 4 * core::kNanosecondsPerSecond);

  const std::string whole = write("whole.bag", 0, 120);
  EXPECT_EQ(split.fingerprint, BagReader(whole).summary().fingerprint);
  EXPECT_EQ(split.messages, BagReader(whole).summary().messages);
  // /map has one event: its first message is what the recorder got when it subscribed.
  EXPECT_EQ(read(files), read({whole}));
  EXPECT_EQ(read({write("new_0.bag", 0, 70), write("new_1.bag", 70, 120)}), read({whole}))
      << "a new map at the split";
  fs::resize_file(files[1], fs::file_size(files[1]) / 2);
  EXPECT_TRUE(begins(problemOf<BagError>([&] { BagReader reader(files); }), files[1] + ": "));
}

TEST_F(RecordingFilesTest, WhatWasLatchedAndIsRepeatedIsNoMessage) {
  const std::vector<Said> plain = read({write("whole.bag", 0, 120)});
  for (const Repeated repeated : {Repeated::kWithoutSender, Repeated::kWithSender}) {
    EXPECT_EQ(read({write("run_0.bag", 0, 40), write("run_1.bag", 40, 80, repeated),
                    write("run_2.bag", 80, 120, repeated)}),
              plain);
  }
  // Of a file that is read alone, too: nobody sends without a name.
  for (const Said& said : read({write("run_2.bag", 80, 120, Repeated::kWithoutSender)})) {
    EXPECT_NE(std::get<1>(said).source, "");
  }
}

TEST_F(RecordingFilesTest, MessagesThatOvertakeEachOtherAtASplitAreInOrder) {
  for (const int begin : {0, 2}) {
    rosbag::Bag bag(path("run_" + std::to_string(begin / 2) + ".bag"), rosbag::bagmode::Write);
    bag.write("/a", ros::Time(100, 1000000 * begin), map(0), headerOf<std_msgs::Header>("/fast"));
    bag.write("/a", ros::Time(100, 1000000 * (3 + begin)), map(0),
              headerOf<std_msgs::Header>("/fast"));
    bag.close();
  }
  std::vector<std::int64_t> milliseconds;
  for (const Said& said : read({path("run_0.bag"), path("run_1.bag")})) {
    milliseconds.push_back(std::get<0>(said) / 1000000 - 100000);
  }
  EXPECT_EQ(milliseconds, (std::vector<std::int64_t>{0, 2, 3, 5}));
}

TEST_F(RecordingFilesTest, ASpanIsKnownWithoutTheMessages) {
  const BagSpan span = spanOfBag(write("a.bag", 3, 40));
  const BagSummary summary = BagReader(path("a.bag")).summary();
  EXPECT_EQ(span.start, summary.start);
  EXPECT_EQ(span.end, summary.end);
  EXPECT_EQ(span.messages, summary.messages);
  rosbag::Bag(path("none.bag"), rosbag::bagmode::Write).close();
  EXPECT_EQ(spanOfBag(path("none.bag")).messages, 0U);
  for (const auto& part : {3, 2}) {
    fs::resize_file(path("a.bag"), fs::file_size(path("a.bag")) * (part - 1) / part);
    EXPECT_TRUE(has(errorOf(path("a.bag")), "rosbag reindex"));
  }
}

TEST_F(RecordingFilesTest, FilesOfOtherFormatsAreNamedByTheirBeginning) {
  const std::string zero(1, '\0');
  const std::string mcap = "\x89MCAP0\r\n\x01" + std::string(8, '\x10') + std::string(4, '\x04');
  const std::vector<std::pair<std::string, std::string>> formats{
      {mcap + "ros1 and more", "MCAP; make a bag of it with mcap_to_bag.py"},
      {mcap + "ros2 and more", "MCAP of ROS 2; rosbags-convert"},
      {"SQLite format 3" + zero + "...", "a recording of ROS 2 (SQLite); rosbags-convert"},
      {"\x1f\x8b\x08...", "compressed by gzip; unpack it first"},
      {"PK\x03\x04...", "a zip archive; unpack it first"},
      {"\xfd"
       "7zXZ" +
           zero + "...",
       "compressed by xz; unpack it first"},
      {"#ROSBAG V1.2\n...", "of the format before 2010; write it anew with: rosbag filter"},
      {"", "the file is empty"},
      {"what is this?", "of no format that is known here"}};
  for (const auto& [beginning, said] : formats) {
    writeFile(path("x.bag"), beginning);
    EXPECT_TRUE(begins(errorOf(path("x.bag")), path("x.bag") + ": not a bag of ROS 1: " + said));
  }
}

}  // namespace
}  // namespace self_awareness::ros1
