// What channels of attributes leave out: pauses, and how sources start (docs/method.md,
// section 3.10).

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "../attribute_alarms.h"

namespace self_awareness::core::evidence {
namespace {

// A source that sends for a while, and then pauses.
constexpr std::int64_t kSends = 40 * kSecond;
constexpr std::int64_t kPauses = 30 * kSecond;

Events pausing(unsigned seed) {
  const std::int64_t start = (seed + 1) * kStart;
  const std::int64_t end = start + 5 * (kSends + kPauses);
  Events events = messages(kB, start + 7 * kMillisecond, end, {}, seed + 100);
  for (std::int64_t begin = start; begin < end; begin += kSends + kPauses) {
    events = together({events, messages(kA, begin, begin + kSends, {}, seed)});
  }
  return events;
}

struct Fault {
  std::string channel;
  std::function<void(Event&, std::int64_t)> change;  // given the time since its begin [ns]
};

class PauseTest : public testing::TestWithParam<Fault> {};

TEST_P(PauseTest, AnAlarmEndsWhenItsSourcePauses) {
  const auto model = learned(fourStarts(pausing));
  Events events = pausing(10);
  const std::int64_t pause = events.front().stamp + 2 * (kSends + kPauses) + kSends;
  const std::int64_t onset = pause - 4 * kSecond;
  for (Event& event : events) {
    if (event.id == kA && event.stamp >= onset && event.stamp < pause) {
      GetParam().change(event, event.stamp - onset);
    }
  }
  int before = 0;
  int after = 0;
  judge(model->makeJudge(), events, [&](const Verdict& verdict) {
    if (verdict.evidence.find(GetParam().channel) != std::string::npos) {
      ++(verdict.window->start < pause + kRateSpan ? before : after);
    }
  });
  EXPECT_GT(before, 10);
  EXPECT_EQ(after, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Channels, PauseTest,
    testing::Values(
        Fault{kAge,
              [](Event& event, std::int64_t since) { event.attributes.age = ageClass(since); }},
        Fault{kLost,
              [](Event& event, std::int64_t since) {
                if (since / (100 * kMillisecond) % 2 == 0) {
                  event.attributes.step = Attributes::Step::kLostOne;
                }
              }},
        Fault{kSize, [](Event& event, std::int64_t) { event.attributes.size = sizeClass(10); }},
        Fault{kFrozen, [](Event& event, std::int64_t) { event.attributes.same = true; }}));

TEST(Lost, WhatIsLostFromPauseToPauseAddsUp) {
  const auto model = learned(fourStarts(pausing));
  Events events;
  std::int64_t last = 0;
  for (Event event : pausing(10)) {
    if (event.id == kA) {
      if (event.stamp % (5 * kSecond) < 2500 * kMillisecond) {
        continue;  // the network is down
      }
      if (last > 0 && event.stamp - last > kRateSpan) {
        event.attributes.step = Attributes::Step::kLostMany;
      }
      last = event.stamp;
    }
    events.push_back(event);
  }
  int lost = 0;
  judge(model->makeJudge(), events, [&](const Verdict& verdict) {
    lost += verdict.evidence.find(kLost) != std::string::npos ? 1 : 0;
  });
  EXPECT_GT(lost, 100);
}

double limitOf(const core::Model& model, const std::string& channel) {
  return model.limits()->tracks.at(indexOf(model.watched.tracks, channel, kA, kA));
}

TEST(Start, AFirstStampThatIsOddIsForgotten) {
  const auto usual = learned(Source{});
  for (const std::uint8_t age : {Attributes::kZeroStamp, ageClass(-600 * kSecond)}) {
    const auto model = learned(recordingsWhere([&](Event& event, std::size_t number) {
      if (number < 3) {
        event.attributes.age = age;
      }
    }));
    ASSERT_TRUE(watches(*model, kAge)) << +age;
    EXPECT_NEAR(limitOf(*model, kAge), limitOf(*usual, kAge), 0.01) << +age;
  }
}

TEST(Age, AFewMessagesMayLackAStamp) {
  for (const std::size_t every : {50U, 200U}) {
    const auto model = learned(recordingsWhere([&](Event& event, std::size_t number) {
      if (number % every == every - 1) {
        event.attributes.age = Attributes::kZeroStamp;
      }
    }));
    EXPECT_EQ(watches(*model, kAge), every == 200);
    if (every == 200) {
      EXPECT_LT(limitOf(*model, kAge), 1);
    }
  }
}

TEST(Frozen, APauseBetweenTwoThatAreTheSameIsNoReasonToSwitchItOff) {
  const auto model = learned(fourStarts([](unsigned seed) {
    const std::int64_t start = (seed + 1) * kStart;
    const Events first = messages(kA, start, start + 100 * kSecond, {}, seed);
    Events second = messages(kA, start + 131 * kSecond, start + kLength, {}, seed);
    second[0].attributes.same = true;
    return together({first, second, messages(kB, start, start + kLength, {}, seed + 100)});
  }));
  ASSERT_TRUE(watches(*model, kFrozen));
  EXPECT_LT(limitOf(*model, kFrozen), 4);
}

}  // namespace
}  // namespace self_awareness::core::evidence
