#include "ros/model/bytes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace self_awareness::ros1 {
namespace {

enum class Colour : std::uint8_t { kRed, kGreen };
using Bytes = std::vector<std::uint8_t>;

/// A struct with a field that format 7 added.
struct Example {
  std::int64_t old = 0;
  double added = 0.5;  // where the bytes lack it
};

}  // namespace

template <typename Passing, typename Passed>
void fields(Passing& bytes, Passed& example) {
  bytes(example.old);
  if (bytes.has(7)) {
    bytes(example.added);
  }
}

namespace {

template <typename... Values>
Bytes written(const Values&... values) {
  ByteWriter bytes;
  bytes(values...);
  return bytes.take();
}

/// @return why it cannot be read; empty: it can
template <typename Value>
std::string read(const Bytes& bytes, Value& value, std::uint32_t format = 7,
                 std::size_t most = ByteReader::kMostMemory) {
  ByteReader reader(bytes.data(), bytes.size(), format, most);
  try {
    reader(value);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return reader.done() ? "" : "something is left";
}

template <typename Value>
void expectBack(const Value& value) {
  Value found{};
  EXPECT_EQ(read(written(value), found), "");
  EXPECT_EQ(found, value);
}

template <typename Number>
void expectAllBack() {
  for (const Number number : {std::numeric_limits<Number>::min(), Number{0}, Number{1},
                              std::numeric_limits<Number>::max()}) {
    expectBack(number);
  }
}

TEST(Bytes, ComeBackAsTheyWere) {
  expectAllBack<std::uint8_t>();
  expectAllBack<std::uint32_t>();
  expectAllBack<std::uint64_t>();
  expectAllBack<std::int64_t>();
  expectAllBack<int>();
  expectBack(-1);
  expectBack(true);
  expectBack(Colour::kGreen);
  expectBack(-1e-300);
  expectBack(2.5F);
  expectBack(std::string("/caf\xC3\xA9"));
  expectBack(Bytes{0, 255, 128});
  expectBack(std::vector<std::string>{"", "a"});
  expectBack(std::set<std::pair<std::string, int>>{{"a", -2}, {"b", 1}});
  expectBack(std::map<std::string, std::vector<double>>{{"a", {1, 2}}, {"b", {}}});
  expectBack(std::array<std::uint64_t, 3>{1, 200, 70000});
  expectBack(std::optional<int>());
  expectBack(std::optional<int>(-3));
  double nan = 0;
  EXPECT_EQ(read(written(std::nan("")), nan), "");
  EXPECT_TRUE(std::isnan(nan));
}

TEST(Bytes, SmallNumbersTakeOneByte) {
  EXPECT_EQ(written(std::uint64_t{127}, std::int64_t{-64}, std::int64_t{63}).size(), 3U);
  EXPECT_EQ(written(std::uint64_t{128}), (Bytes{0x80, 1}));
}

TEST(Bytes, OfAnOlderFormatHaveNoFieldThatCameLater) {
  const Example example{3, 2.5};
  Example found;
  EXPECT_EQ(read(written(example), found), "");
  EXPECT_EQ(found.added, 2.5);
  Example old;
  EXPECT_EQ(read(written(std::int64_t{3}), old, 6), "");
  EXPECT_EQ(old.old, 3);
  EXPECT_EQ(old.added, 0.5);
}

TEST(Bytes, AreRefusedWhereverTheyAreCut) {
  using Value = std::map<std::string, std::pair<std::optional<double>, std::vector<int>>>;
  const Bytes whole = written(Value{{"a", {1.0, {1, 300}}}, {"b", {std::nullopt, {}}}});
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    Value value;
    EXPECT_NE(read(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut)), value),
              "")
        << cut;
  }
}

TEST(Bytes, ALengthThatLiesAsksForNoMemory) {
  std::vector<std::string> texts;
  EXPECT_NE(read(written(std::numeric_limits<std::uint64_t>::max()), texts), "");
  EXPECT_TRUE(texts.empty());
  std::vector<std::int64_t> numbers;
  const Bytes many = written(std::vector<std::int64_t>(1000));
  EXPECT_NE(read(many, numbers, 7, 7999), "");
  EXPECT_EQ(read(many, numbers, 7, 8000), "");
}

TEST(Bytes, NumbersThatDoNotFitAreRefused) {
  std::uint8_t small = 0;
  EXPECT_NE(read(written(256), small), "");
  std::uint32_t wide = 0;
  EXPECT_NE(read(written(std::uint64_t{1} << 32U), wide), "");
  int negative = 0;
  EXPECT_NE(read(written(-(std::int64_t{1} << 40U)), negative), "");
  bool flag = false;
  EXPECT_NE(read(Bytes{2}, flag), "");
  std::uint64_t number = 0;
  EXPECT_NE(read(Bytes(9, 0xFF), number), "");
  EXPECT_NE(read(Bytes{255, 255, 255, 255, 255, 255, 255, 255, 255, 2}, number), "");
  EXPECT_NE(read(Bytes(12, 0x80), number), "");
}

TEST(Bytes, WhatIsThereTwiceIsRefused) {
  std::set<int> set;
  EXPECT_NE(read(written(std::vector<int>{5, 5}), set), "");
  std::map<int, int> map;
  EXPECT_NE(read(written(std::vector<std::pair<int, int>>{{5, 1}, {5, 2}}), map), "");
}

TEST(Bytes, TextsThatNoTerminalShouldGetAreRefused) {
  for (const char* text : {"a\x1B[2J", "\xFC", "/a\xE2\x80\xAE"}) {
    std::string found;
    EXPECT_NE(read(written(std::string(text)), found), "");
  }
  std::string found;
  EXPECT_NE(read(written(std::string(1U << 17U, 'x')), found), "");
}

}  // namespace
}  // namespace self_awareness::ros1
