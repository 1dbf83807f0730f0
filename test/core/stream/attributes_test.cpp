#include "self_awareness/core/stream/attributes.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::core {
namespace {

using Step = Attributes::Step;

TEST(Attributes, TakeNoRoomInAnEvent) {
  EXPECT_EQ(sizeof(Event), 16U);
  EXPECT_FALSE(Event{}.attributes.isKnown());
}

TEST(Attributes, AgesAndSizesAreKnownToNinePercent) {
  for (double age = 1.1e-3; age < 1900; age *= 1.07) {
    const std::uint8_t number = ageClass(toNanoseconds(age));
    EXPECT_NEAR(ageOf(number), age, 0.05 * age);
    EXPECT_GE(ageClass(toNanoseconds(1.1 * age)), number + 1);
    EXPECT_NEAR(ageOf(ageClass(-toNanoseconds(age))), -age, 0.1 * age);
  }
  for (double size = 20; size < 1e9; size *= 1.1) {
    EXPECT_NEAR(sizeOf(sizeClass(static_cast<std::uint64_t>(size))), size, 0.05 * size + 1);
  }
  EXPECT_EQ(sizeOf(sizeClass(0)), 0);
  EXPECT_NE(sizeClass(0), Attributes::kNoSize);
  EXPECT_EQ(sizeClass(std::numeric_limits<std::uint64_t>::max()), Attributes::kLargestSize);
}

TEST(Attributes, OlderAgesHaveLargerClasses) {
  std::uint8_t last = 0;
  for (const double age : {-1e9, -1500.0, -1.0, -0.002, 0.0, 0.002, 1.0, 3000.0}) {
    const std::uint8_t number = ageClass(toNanoseconds(age));
    EXPECT_GT(number, last) << age;
    EXPECT_GE(number, Attributes::kYoungest);
    last = number;
  }
  EXPECT_EQ(ageOf(ageClass(999999)), 0);
  EXPECT_EQ(ageOf(ageClass(-999999)), 0);
  EXPECT_EQ(ageClass(std::numeric_limits<std::int64_t>::max()), 254);
  EXPECT_EQ(ageClass(std::numeric_limits<std::int64_t>::min()), Attributes::kYoungest);
}

TEST(Attributes, NumbersSayWhatIsMissing) {
  EXPECT_EQ(stepOf(7, 8), Step::kNext);
  EXPECT_EQ(stepOf(7, 7), Step::kSame);
  EXPECT_EQ(stepOf(7, 9), Step::kLostOne);
  EXPECT_EQ(stepOf(7, 11), Step::kLostFew);
  EXPECT_EQ(stepOf(7, 12), Step::kLostSome);
  EXPECT_EQ(stepOf(7, 24), Step::kLostMany);
  EXPECT_EQ(stepOf(7, 1008), Step::kLostMany);
  EXPECT_EQ(stepOf(7, 1009), Step::kRestart);
  EXPECT_EQ(stepOf(7, 0), Step::kRestart);
  EXPECT_EQ(stepOf(0xffffffff, 0), Step::kNext) << "it runs over";
}

TEST(Attributes, ArePackedIntoANumber) {
  EXPECT_EQ(packed({}), 0U);
  for (const Attributes& each : {Attributes{}, Attributes{254, 255, Step::kRestart, true},
                                 Attributes{1, 2, Step::kLostOne, false}}) {
    EXPECT_EQ(unpackedAttributes(packed(each)), each);
  }
  EXPECT_THROW(unpackedAttributes(1U << 25U), std::invalid_argument);
  EXPECT_THROW(unpackedAttributes(8U << 16U), std::invalid_argument);
}

}  // namespace
}  // namespace self_awareness::core
