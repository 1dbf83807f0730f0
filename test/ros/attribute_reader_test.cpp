#include "self_awareness/ros/attribute_reader.h"

#include <gtest/gtest.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/String.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "self_awareness/core/stream/event.h"
#include "serialized.h"

namespace self_awareness::ros1 {
namespace {

using core::Attributes;
constexpr std::int64_t kNow = 1700000000000000000;

AttributeReader readerOf(const std::string& definition, const std::string& datatype,
                         bool latching = false) {
  return AttributeReader({"", "", datatype, definition, latching, ""});
}

template <typename Message>
AttributeReader readerOf(bool latching = false) {
  namespace traits = ros::message_traits;
  return readerOf(traits::definition<Message>(), traits::datatype<Message>(), latching);
}

Attributes read(AttributeReader& reader, const std::vector<std::uint8_t>& bytes) {
  return reader.read(bytes, kNow);
}

/// Whether it finds an age where there would be a header.
bool hasHeader(AttributeReader reader) {
  return read(reader, std::vector<std::uint8_t>(40, 1)).age != Attributes::kNoAge;
}

sensor_msgs::Image image(std::uint32_t number, double age, std::size_t size = 100000) {
  sensor_msgs::Image message;
  message.header.seq = number;
  message.header.stamp.fromNSec(static_cast<std::uint64_t>(kNow - core::toNanoseconds(age)));
  message.header.frame_id = "camera";
  message.data.resize(size, 7);
  return message;
}

TEST(AttributeReader, KnowsAHeaderByTheDefinition) {
  EXPECT_TRUE(hasHeader(readerOf<sensor_msgs::Image>()));
  EXPECT_FALSE(hasHeader(readerOf<std_msgs::String>()));
  EXPECT_FALSE(hasHeader(readerOf("", "*")));
  EXPECT_FALSE(hasHeader(readerOf("Header header\n", "a/B"))) << "it is not defined";
  const std::string header =
      "====\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";
  EXPECT_TRUE(hasHeader(readerOf("# of it\nHeader header\nint8 x\n" + header, "a/B")));
  EXPECT_TRUE(hasHeader(readerOf("std_msgs/Header h\n" + header, "a/B")));
  EXPECT_FALSE(hasHeader(readerOf("int8 x\nHeader header\n" + header, "a/B")));
  EXPECT_FALSE(hasHeader(readerOf("Header[] headers\n" + header, "a/B")));
  const std::string element = "====\nMSG: a/C\nHeader header\n" + header;
  EXPECT_TRUE(hasHeader(readerOf("C[] all\n" + element, "a/B")));
  EXPECT_FALSE(hasHeader(readerOf("int8 x\nC[] all\n" + element, "a/B")));
  EXPECT_FALSE(hasHeader(readerOf("C[2] both\n" + element, "a/B")));
  EXPECT_FALSE(
      hasHeader(readerOf("Header header\n====\nMSG: std_msgs/Header\nuint8 other\n", "a/B")));
}

TEST(AttributeReader, ReadsAgeNumberSizeAndContent) {
  AttributeReader reader = readerOf<sensor_msgs::Image>();
  const Attributes first = read(reader, serialized(image(5, 0.2)));
  EXPECT_EQ(first.age, core::ageClass(core::toNanoseconds(0.2)));
  EXPECT_EQ(first.size, core::sizeClass(serialized(image(5, 0.2)).size()));
  EXPECT_EQ(first.step, Attributes::Step::kNotKnown);
  EXPECT_FALSE(first.same);
  const Attributes second = read(reader, serialized(image(6, 0.1)));
  EXPECT_EQ(second.step, Attributes::Step::kNext);
  EXPECT_TRUE(second.same) << "the header is no content";
  sensor_msgs::Image other = image(8, -3);
  other.data[0] = 8;
  const Attributes third = read(reader, serialized(other));
  EXPECT_EQ(third.step, Attributes::Step::kLostOne);
  EXPECT_LT(core::ageOf(third.age), -2);
  EXPECT_FALSE(third.same);
  EXPECT_FALSE(read(reader, serialized(image(9, 0, 99999))).same);
  other.header.stamp = ros::Time();
  EXPECT_EQ(read(reader, serialized(other)).age, Attributes::kZeroStamp);
  EXPECT_EQ(read(reader, std::vector<std::uint8_t>(15)).age, Attributes::kNoAge)
      << "the header is cut off";
  EXPECT_FALSE(read(reader, std::vector<std::uint8_t>(16, 0xff)).same)
      << "a frame_id longer than any message";
}

TEST(AttributeReader, TheFirstOfAnArrayTellsTheAge) {
  visualization_msgs::MarkerArray message;
  const std::size_t empty = serialized(message).size();
  message.markers.resize(2);
  message.markers[0].header = image(7, 3).header;
  message.markers[1].header = image(9, 0.1).header;
  AttributeReader reader = readerOf<visualization_msgs::MarkerArray>();
  const Attributes found = read(reader, serialized(message));
  EXPECT_EQ(found.age, core::ageClass(3 * core::kNanosecondsPerSecond));
  EXPECT_FALSE(reader.number()) << "each has one of its own";
  EXPECT_TRUE(read(reader, serialized(message)).same);
  message.markers[0].header.stamp += ros::Duration(1);
  EXPECT_FALSE(read(reader, serialized(message)).same) << "the header is content";
  message.markers[0].header.stamp -= ros::Duration(1);
  EXPECT_EQ(read(reader, std::vector<std::uint8_t>(empty)).age, Attributes::kNoAge);
  EXPECT_EQ(read(reader, std::vector<std::uint8_t>(40)).age, Attributes::kNoAge)
      << "what comes behind an empty array is no header";
}

TEST(AttributeReader, OfLinesForPeopleNothingIsKnown) {
  AttributeReader reader =
      readerOf(ros::message_traits::definition<sensor_msgs::Image>(), "rosgraph_msgs/Log");
  const std::vector<std::uint8_t> bytes = serialized(image(1, 0.02));
  EXPECT_EQ(read(reader, bytes), Attributes{});
  const auto never = [](std::uint64_t /*from*/, std::uint64_t /*to*/) {
    ADD_FAILURE() << "nothing is to be read";
    return std::string_view();
  };
  reader.read(1000, never, kNow);
}

TEST(AttributeReader, ALatchingPublisherAlsoNumbersWhatItSendsToNewSubscribers) {
  AttributeReader plain = readerOf<sensor_msgs::Image>();
  AttributeReader latching = readerOf<sensor_msgs::Image>(true);
  for (const std::uint32_t number : {1U, 2U, 4U}) {
    const std::vector<std::uint8_t> bytes = serialized(image(number, 0.02));
    EXPECT_EQ(read(plain, bytes).isAfterLoss(), number == 4);
    EXPECT_EQ(read(latching, bytes).step, Attributes::Step::kNotKnown);
  }
}

}  // namespace
}  // namespace self_awareness::ros1
