// Definitions and messages of strangers: each is read, or refused.

#include "self_awareness/ros/message_field.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace self_awareness::ros1 {
namespace {

std::string errorOf(const std::string& definition) {
  try {
    MessageField(definition, "test/Message", "action");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

std::string read(const std::string& definition, const std::string& message) {
  const MessageField field(definition, "test/Message", "action");
  return field.read(reinterpret_cast<const std::uint8_t*>(message.data()), message.size());
}

const std::string kSeven("\7\0\0\0", 4);

TEST(BadDefinition, ARingOfTypesIsRefused) {
  EXPECT_NE(errorOf("test/Message self\nint32 action\n").find("in a ring"), std::string::npos);
  EXPECT_NE(errorOf("A a\nint32 action\n====\nMSG: test/A\nB[] b\n====\nMSG: test/B\nA[3] a\n")
                .find("in a ring"),
            std::string::npos);
}

TEST(BadDefinition, ALengthThatCannotBeIsRefused) {
  for (const char* type :
       {"uint8[99999999999999999999]", "uint8[-1]", "uint8[x]", "uint8[4294967296]", "string[",
        "uint8[1][2]", "float64[999999999]", "uint8[ 1]"}) {
    EXPECT_NE(errorOf(std::string(type) + " x\nint32 action\n"), "") << type;
  }
}

TEST(BadDefinition, LengthsThatMultiplyAreRefused) {
  // 10^9 elements of 10^9 bytes: the product of 64 bits would wrap with two levels more.
  std::string definition = "A[999999999] a\nint32 action\n";
  for (const char* type : {"A", "B", "C"}) {
    definition += std::string("====\nMSG: test/") + type + "\n" + static_cast<char>(type[0] + 1) +
                  "[999999999] x\n";
  }
  EXPECT_NE(errorOf(definition + "====\nMSG: test/D\nuint8[999999999] x\n"), "");
}

TEST(BadDefinition, TypesThatDoubleAtEveryLevelAreRefused) {
  std::string definition = "T0 a\nint32 action\n";
  for (int level = 0; level < 30; ++level) {
    const std::string next = "T" + std::to_string(level + 1);
    definition +=
        "====\nMSG: test/T" + std::to_string(level) + "\n" + next + " x\n" + next + " y\n";
  }
  EXPECT_NE(errorOf(definition + "====\nMSG: test/T30\nuint8 x\n").find("more than 10000 fields"),
            std::string::npos);
}

TEST(BadDefinition, ATextOfMegabytesIsRefused) {
  EXPECT_NE(errorOf(std::string(2000000, '#') + "\nint32 action\n"), "");
}

TEST(BadDefinition, ManyStringsEndWithTheMessage) {
  EXPECT_THROW(read("string[999999999] x\nint32 action\n", kSeven), std::out_of_range);
  EXPECT_THROW(read("string[] x\nint32 action\n", std::string(4, '\xFF')), std::out_of_range);
  EXPECT_THROW(read("uint8[] x\nint32 action\n", std::string(4, '\xFF')), std::out_of_range);
  EXPECT_THROW(read("string x\nint32 action\n", std::string(4, '\xFF')), std::out_of_range);
}

TEST(BadDefinition, ElementsOfNoBytesTakeNoTime) {
  const std::string empty = "====\nMSG: test/Empty\n";
  EXPECT_EQ(read("Empty[999999999] x\nint32 action\n" + empty, kSeven), "7");
  EXPECT_EQ(read("Empty[] x\nint32 action\n" + empty, std::string(4, '\xFF') + kSeven), "7");
  EXPECT_EQ(read("string[0] x\nint32 action\n", kSeven), "7");
}

TEST(BadDefinition, ArraysOfFixedLengthAreCrossed) {
  const std::string two_strings("\1\0\0\0a\2\0\0\0bc", 11);
  EXPECT_EQ(read("string[2] x\nfloat64[2] y\nint32 action\n",
                 two_strings + std::string(16, '\0') + kSeven),
            "7");
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
