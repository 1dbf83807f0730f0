// Definitions and messages of strangers: each is read, or refused.

#include "ros/message_field.h"

#include <gtest/gtest.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include <stdexcept>
#include <string>

#include "../problem.h"
#include "serialized.h"

namespace self_awareness::ros1 {
namespace {

std::string errorOf(const std::string& definition) {
  return problemOf([&] { MessageField(definition, "test/Message", "action"); });
}

template <typename Message>
MessageField fieldOf(const std::string& field) {
  namespace traits = ros::message_traits;
  return {traits::definition<Message>(), traits::datatype<Message>(), field};
}

std::string read(const std::string& definition, const std::string& message) {
  const MessageField field(definition, "test/Message", "action");
  return field.read(reinterpret_cast<const std::uint8_t*>(message.data()), message.size());
}

template <typename Message>
std::string readField(const Message& message, const std::string& field) {
  const std::vector<std::uint8_t> bytes = serialized(message);
  return fieldOf<Message>(field).read(bytes.data(), bytes.size());
}

const std::string kSeven("\7\0\0\0", 4);

TEST(MessageField, ReadsAfterStringsArraysAndNestedMessages) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = "map";
  marker.ns = "people";
  marker.id = -7;
  marker.action = visualization_msgs::Marker::DELETE;
  marker.points.resize(3);
  marker.text = "Ada";
  marker.mesh_use_embedded_materials = 1;
  EXPECT_EQ(readField(marker, "action"), "2");
  EXPECT_EQ(readField(marker, "id"), "-7");
  EXPECT_EQ(readField(marker, "ns"), "people");
  EXPECT_EQ(readField(marker, "header.frame_id"), "map");
  EXPECT_EQ(readField(marker, "text"), "Ada");
  EXPECT_EQ(readField(marker, "mesh_use_embedded_materials"), "1");

  sensor_msgs::PointCloud2 cloud;
  cloud.fields.resize(2);  // an array of messages that hold a string
  cloud.fields[0].name = "x";
  cloud.fields[1].name = "intensity";
  cloud.point_step = 4000000000U;
  cloud.data.resize(17);
  cloud.is_dense = 1;
  EXPECT_EQ(readField(cloud, "point_step"), "4000000000");
  EXPECT_EQ(readField(cloud, "is_dense"), "1");

  rosgraph_msgs::Log log;
  log.level = rosgraph_msgs::Log::ERROR;
  log.name = std::string(200, 'n');
  EXPECT_EQ(readField(log, "level"), "8");
  EXPECT_EQ(readField(log, "name"), std::string(64, 'n'));
}

TEST(MessageField, SaysWhatIsWrongWithAField) {
  const auto errorOf = [](const std::string& field) {
    return problemOf([&] { fieldOf<visualization_msgs::Marker>(field); });
  };
  EXPECT_EQ(errorOf("verb"), "type field visualization_msgs/Marker: verb: has no field 'verb'");
  EXPECT_TRUE(has(errorOf("pose"), "is a message itself"));
  EXPECT_TRUE(has(errorOf("points"), "is an array"));
  EXPECT_TRUE(has(errorOf("scale.x"), "is a float64"));
  EXPECT_TRUE(has(errorOf("pose.speed"), "in its geometry_msgs/Pose"));
}

TEST(MessageField, RefusesAMessageThatIsTooShort) {
  visualization_msgs::Marker marker;
  marker.ns = "people";
  const std::vector<std::uint8_t> buffer = serialized(marker);
  const auto field = fieldOf<visualization_msgs::Marker>("action");
  for (std::size_t size = 0; size < 34; ++size) {  // action ends after 12 + 4 + 4 + 4 + 6 + 4 + 4
    EXPECT_THROW(field.read(buffer.data(), size), std::out_of_range) << size;
  }
}

TEST(BadDefinition, ARingOfTypesIsRefused) {
  EXPECT_TRUE(has(errorOf("test/Message self\nint32 action\n"), "in a ring"));
  EXPECT_TRUE(
      has(errorOf("A a\nint32 action\n====\nMSG: test/A\nB[] b\n====\nMSG: test/B\nA[3] a\n"),
          "in a ring"));
}

TEST(BadDefinition, ALengthThatCannotBeIsRefused) {
  for (const char* type :
       {"uint8[99999999999999999999]", "uint8[-1]", "uint8[x]", "uint8[4294967296]", "string[",
        "uint8[1][2]", "float64[999999999]", "uint64[4294967295]", "uint8[ 1]"}) {
    EXPECT_NE(errorOf(std::string(type) + " x\nint32 action\n"), "") << type;
  }
}

TEST(BadDefinition, WhatMultipliesIsRefused) {
  // 10^9 elements of 10^9 bytes: the product of 64 bits would wrap with two levels more.
  std::string lengths = "A[999999999] a\nint32 action\n";
  for (const char* type : {"A", "B", "C"}) {
    lengths += std::string("====\nMSG: test/") + type + "\n" + static_cast<char>(type[0] + 1) +
               "[999999999] x\n";
  }
  EXPECT_NE(errorOf(lengths + "====\nMSG: test/D\nuint8[999999999] x\n"), "");
  std::string types = "T0 a\nint32 action\n";
  for (int level = 0; level < 30; ++level) {
    const std::string next = "T" + std::to_string(level + 1);
    types += "====\nMSG: test/T" + std::to_string(level) + "\n" + next + " x\n" + next + " y\n";
  }
  EXPECT_TRUE(has(errorOf(types + "====\nMSG: test/T30\nuint8 x\n"), "more than 10000 fields"));
  EXPECT_NE(errorOf(std::string(2000000, '#') + "\nint32 action\n"), "");
}

TEST(BadDefinition, ArraysEndWithTheMessage) {
  for (const char* type : {"string[]", "uint8[]", "string"}) {
    EXPECT_THROW(read(std::string(type) + " x\nint32 action\n", std::string(4, '\xFF')),
                 std::out_of_range);
  }
  EXPECT_THROW(read("string[999999999] x\nint32 action\n", kSeven), std::out_of_range);
  EXPECT_EQ(read("string[2] x\nfloat64[2] y\nint32 action\n",
                 std::string("\1\0\0\0a\2\0\0\0bc", 11) + std::string(16, '\0') + kSeven),
            "7");
}

TEST(BadDefinition, ElementsOfNoBytesTakeNoTime) {
  const std::string empty = "====\nMSG: test/Empty\n";
  EXPECT_EQ(read("Empty[999999999] x\nint32 action\n" + empty, kSeven), "7");
  EXPECT_EQ(read("Empty[] x\nint32 action\n" + empty, std::string(4, '\xFF') + kSeven), "7");
  EXPECT_EQ(read("string[0] x\nint32 action\n", kSeven), "7");
}

TEST(BadDefinition, WhatItSaysOfNamesIsShortAndUtf8) {
  const std::string error =
      errorOf("int32 x\n====\nMSG: test/\xFF" + std::string(5000, 'a') + "\n");
  EXPECT_LT(error.size(), 200U);
  const std::string missing = errorOf("test/\xFF" + std::string(5000, 'a') + " x\nint32 action\n");
  EXPECT_LT(missing.size(), 200U);
  EXPECT_EQ(missing.find('\xFF'), std::string::npos);
}

}  // namespace
}  // namespace self_awareness::ros1
