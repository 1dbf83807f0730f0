// Tests bags that are written: rosbag reads them, and a full disk is an error.

#include "self_awareness/ros/bag/bag_writer.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt32.h>
#include <sys/resource.h>

#include <boost/filesystem.hpp>
#include <csignal>
#include <random>
#include <string>

#include "../../in_folder.h"
#include "../../problem.h"
#include "self_awareness/ros/bag/bag_reader.h"

namespace self_awareness::ros1 {
namespace {

namespace fs = boost::filesystem;

constexpr std::uint32_t kMessages = 3000;

class BagWriterTest : public InFolder, public testing::WithParamInterface<BagWriter::Chunks> {
 protected:
  /// Texts that cannot be compressed and numbers, in turn; the stamps do not rise.
  void write(BagWriter& bag) const {
    std::mt19937 random(1);
    for (std::uint32_t i = 0; i < kMessages; ++i) {
      std_msgs::String text;
      for (int byte = 0; byte < 900; ++byte) {
        text.data.push_back(static_cast<char>(random()));
      }
      std_msgs::UInt32 number;
      number.data = i;
      bag.write({"/text", "/talker", false, {}}, ros::Time(1 + (i ^ 1U), 0), text);
      bag.write({"/number", "/counter", true, {{"more", "of it"}}}, ros::Time(1 + i, 500), number);
    }
  }

  const std::string path_ = path("a.bag");
};

TEST_P(BagWriterTest, RosbagReadsAllOfIt) {
  BagWriter writer(path_, GetParam());
  write(writer);
  writer.close();
  EXPECT_EQ(writer.size(), fs::file_size(path_));
  const rosbag::Bag bag(path_, rosbag::bagmode::Read);
  rosbag::View view(bag);
  ASSERT_EQ(view.size(), 2 * kMessages);
  EXPECT_EQ(view.getBeginTime(), ros::Time(1, 0));
  EXPECT_EQ(view.getEndTime(), ros::Time(kMessages, 500));
  rosbag::View numbers(bag, rosbag::TopicQuery("/number"));
  std::uint32_t next = 0;
  for (const rosbag::MessageInstance& message : numbers) {
    EXPECT_EQ(message.getTime(), ros::Time(1 + next, 500));
    EXPECT_EQ(message.getCallerId(), "/counter");
    EXPECT_TRUE(message.isLatching());
    EXPECT_EQ(message.getConnectionHeader()->at("more"), "of it");
    ASSERT_EQ(message.instantiate<std_msgs::UInt32>()->data, next++);
  }
  EXPECT_EQ(next, kMessages);
  rosbag::View texts(bag, rosbag::TopicQuery("/text"));
  std::uint32_t read = 0;
  for (const rosbag::MessageInstance& message : texts) {
    EXPECT_EQ(message.getCallerId(), "/talker");
    EXPECT_FALSE(message.isLatching());
    EXPECT_EQ(message.instantiate<std_msgs::String>()->data.size(), 900U);
    ++read;
  }
  EXPECT_EQ(read, kMessages);
}

TEST_P(BagWriterTest, ADiskThatBecomesFullIsAnErrorThatNamesTheFile) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{1000000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string error = problemOf<BagError>([this] {
    BagWriter writer(path_, GetParam(), "result.bag");
    write(writer);
    writer.close();
  });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(error, "result.bag: cannot be written (File too large)");
}

INSTANTIATE_TEST_SUITE_P(Chunks, BagWriterTest,
                         ::testing::Values(BagWriter::Chunks::kOfOneMessage,
                                           BagWriter::Chunks::kCompressed));

TEST_F(BagWriterTest, SameMessagesMakeASmallFileWhereTheyAreCompressed) {
  for (const BagWriter::Chunks chunks :
       {BagWriter::Chunks::kOfOneMessage, BagWriter::Chunks::kCompressed}) {
    BagWriter writer(path_ + std::to_string(static_cast<int>(chunks)), chunks);
    std_msgs::String text;
    text.data = std::string(1000, 'a');
    for (std::uint32_t i = 0; i < kMessages; ++i) {
      writer.write({"/text"}, ros::Time(1 + i, 0), text);
    }
    writer.close();
  }
  EXPECT_LT(10 * fs::file_size(path_ + "1"), fs::file_size(path_ + "0"));
  BagWriter(path_, BagWriter::Chunks::kCompressed).close();
  EXPECT_EQ(rosbag::View(rosbag::Bag(path_, rosbag::bagmode::Read)).size(), 0U) << "of none";
}

}  // namespace
}  // namespace self_awareness::ros1
