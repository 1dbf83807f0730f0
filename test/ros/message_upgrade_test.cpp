// Messages that other versions laid out: read by the names of their fields, or refused.

#include "ros/message_upgrade.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "../problem.h"

namespace self_awareness::ros1 {
namespace {

std::string bytesOf(std::uint32_t number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

std::string bytesOf(const std::string& text) {
  return bytesOf(static_cast<std::uint32_t>(text.size())) + text;
}

std::string upgraded(const std::string& from, const std::string& to, const std::string& message) {
  const MessageUpgrade upgrade(MessageDefinition(from, "test/M"), MessageDefinition(to, "test/M"));
  const std::vector<std::uint8_t> bytes =
      upgrade.apply(reinterpret_cast<const std::uint8_t*>(message.data()), message.size());
  return {bytes.begin(), bytes.end()};
}

std::string errorOf(const std::string& from, const std::string& to,
                    const std::string& message = "") {
  return problemOf([&] { upgraded(from, to, message); });
}

const std::string kTrack = "====\nMSG: test/Track\n";

TEST(MessageUpgrade, FieldsAreMatchedByTheirNames) {
  EXPECT_EQ(upgraded("uint32 a\nstring b\nuint32 c\n", "string b\nuint32 c\nuint32 a\n",
                     bytesOf(1) + bytesOf("two") + bytesOf(3)),
            bytesOf("two") + bytesOf(3) + bytesOf(1));
}

TEST(MessageUpgrade, WhatTheFileLacksIsZeroOrEmpty) {
  EXPECT_EQ(
      upgraded("uint32 a\n",
               "float64 x\nuint32 a\nstring s\nuint8[] bytes\nTrack one\nTrack[] many\n"
               "uint8[3] fixed\nstring[2] texts\n" +
                   kTrack + "uint8 channel\nstring name\ntime stamp\n",
               bytesOf(7)),
      std::string(8, '\0') + bytesOf(7) + std::string(4 + 4 + (1 + 4 + 8) + 4 + 3 + 8, '\0'));
}

TEST(MessageUpgrade, WhatThisVersionDoesNotKnowIsLeftOut) {
  EXPECT_EQ(upgraded("string new\nuint32 a\nTrack[] tracks\nstring[2] newer\nuint32 b\n" + kTrack +
                         "string name\n",
                     "uint32 a\nuint32 b\n",
                     bytesOf("no") + bytesOf(1) + bytesOf(1) + bytesOf("track") + bytesOf("x") +
                         bytesOf("") + bytesOf(2)),
            bytesOf(1) + bytesOf(2));
}

TEST(MessageUpgrade, MessagesWithinAreUpgradedToo) {
  const std::string from =
      "Track first\nTrack[] rest\nTrack[2] pair\n" + kTrack + "uint32 gone\nstring name\n";
  const std::string to =
      "Track[] rest\nTrack first\nTrack[2] pair\n" + kTrack + "string name\nuint8 added\n";
  const auto old = [](const std::string& name) { return bytesOf(9) + bytesOf(name); };
  const auto now = [](const std::string& name) { return bytesOf(name) + std::string(1, '\0'); };
  EXPECT_EQ(upgraded(from, to, old("a") + bytesOf(2) + old("b") + old("c") + old("d") + old("e")),
            bytesOf(2) + now("b") + now("c") + now("a") + now("d") + now("e"));
  EXPECT_EQ(upgraded(from, to, old("a") + bytesOf(0U) + old("d") + old("e")),
            bytesOf(0U) + now("a") + now("d") + now("e"));
}

TEST(MessageUpgrade, AFieldOfAnotherTypeIsAnError) {
  for (const char* other : {"uint64 limit", "uint32[] limit", "uint32[2] limit", "string limit",
                            "Track limit\n====\nMSG: test/Track\nuint32 x"}) {
    const std::string error = errorOf(std::string(other) + "\n", "uint32 limit\n", bytesOf(1));
    EXPECT_TRUE(begins(error, "field limit of test/M is of the type "));
  }
  EXPECT_NE(errorOf("Track[] t\n" + kTrack + "uint8 channel\n",
                    "Track[] t\n" + kTrack + "uint16 channel\n"),
            "");
}

TEST(BadUpgrade, AMessageIsRefusedWhereverItIsCut) {
  const std::string from = "Track[] rest\nuint32 gone\n" + kTrack + "string name\n";
  const std::string to = "uint8 added\nTrack[] rest\n" + kTrack + "string name\nuint8 added\n";
  const std::string whole = bytesOf(2) + bytesOf("a") + bytesOf("bcd") + bytesOf(7);
  ASSERT_EQ(errorOf(from, to, whole), "");
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    EXPECT_EQ(errorOf(from, to, whole.substr(0, cut)), "a length in it is wrong") << cut;
  }
  EXPECT_EQ(errorOf(from, to, whole + "x"), "there is more in it than belongs to it");
}

TEST(BadUpgrade, NumbersThatLieOrGrowAskForNoMemory) {
  const std::string from = "Track[] rest\n" + kTrack + "uint8 a\n";
  const std::string to = "Track[] rest\n" + kTrack + "uint8 a\nuint8[1000000] added\n";
  for (const std::uint32_t length : {0xFFFFFFFFU, 0x3FFFFFFFU, 2U}) {
    EXPECT_EQ(errorOf(from, to, bytesOf(length)), "a length in it is wrong");
  }
  EXPECT_EQ(errorOf(from, to, bytesOf(2000) + std::string(2000, 'x')),
            "it is larger than a message can be");
}

TEST(BadUpgrade, ElementsOfNoBytesAreRefused) {
  // Each would become one of a thousand bytes.
  const std::string to = "Track[] rest\n" + kTrack + "uint8[1000] added\n";
  const std::string from = "Track[] rest\n" + kTrack + "string[0] none\n";
  EXPECT_EQ(errorOf(from, to, bytesOf(0xFFFFFFFFU)),
            "an array in it has elements without any field");
  EXPECT_EQ(errorOf(from, to, bytesOf(0U)), "");
}

TEST(BadUpgrade, AFieldOfNoBytesTakesNoTime) {
  std::string from = "Track[] rest\n" + kTrack + "uint8 a\n";
  for (int k = 0; k < 9000; ++k) {
    from += "string[0] x" + std::to_string(k) + "\n";
  }
  const std::uint32_t number = 1000000;
  EXPECT_EQ(upgraded(from, "Track[] rest\n" + kTrack + "uint8 a\nuint8 b\n",
                     bytesOf(number) + std::string(number, 'x'))
                .size(),
            4 + 2 * number);
}

TEST(BadUpgrade, DefinitionsThatCannotBeAreRefused) {
  EXPECT_NE(errorOf("Track[] rest\n", "Track[] rest\n" + kTrack + "uint8 a\n"), "")
      << "a definition is missing";
  EXPECT_NE(errorOf("M self\n", "uint8 a\n"), "") << "a ring";
  EXPECT_NE(errorOf("Track t\n" + kTrack + "Track t\n", "Track t\n" + kTrack + "uint8 t\n"), "");
  std::string many;
  for (int k = 0; k <= MessageDefinition::kMostFields; ++k) {
    many += "uint8 x\n";
  }
  EXPECT_NE(errorOf(many, "uint8 a\n"), "");
}

}  // namespace
}  // namespace self_awareness::ros1
