// Tests that packed events come out as they went in, and that damage is noticed.

#include "ros/bag/packed_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace self_awareness::ros1 {
namespace {

using core::Event;
using self_awareness::EventLog;

EventLog packed(const std::vector<Event>& events) {
  EventLog part;
  pack(events, part);
  return part;
}

bool same(const std::vector<Event>& a, const std::vector<Event>& b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](const Event& x, const Event& y) {
           return x.stamp == y.stamp && x.id == y.id && x.attributes == y.attributes;
         });
}

TEST(PackedEvents, ComeOutAsTheyWentIn) {
  constexpr std::int64_t kNow = 1790000000123456789;
  const std::vector<std::vector<Event>> cases{
      {},
      {{kNow, 0}},
      {{kNow, 7}, {kNow, 7}, {kNow, 0}},
      {{0, 1}, {std::numeric_limits<std::int64_t>::max(), 2}},
      {{kNow, 0}, {kNow + 1, 4294967295}, {kNow + 86400 * core::kNanosecondsPerSecond, 3}}};
  for (const std::vector<Event>& events : cases) {
    EXPECT_TRUE(same(unpack(packed(events)), events)) << events.size();
  }
  EXPECT_THROW(packed({{2, 0}, {1, 0}}), std::invalid_argument) << "time goes back";
}

TEST(PackedEvents, OfAnyRobotComeOutAsTheyWentIn) {
  std::mt19937_64 random(7);
  for (int robot = 0; robot < 200; ++robot) {
    const double mean = std::exp(std::uniform_real_distribution<>(0, 28)(random));  // [ns]
    std::exponential_distribution<> delay(1 / mean);
    std::uniform_int_distribution<core::EventId> id(0, static_cast<core::EventId>(random() % 600));
    std::vector<Event> events;
    std::int64_t stamp = static_cast<std::int64_t>(random() % (1ULL << 61U));
    for (std::size_t k = random() % 300; k > 0; --k) {
      stamp += random() % 5 == 0 ? 0 : static_cast<std::int64_t>(delay(random));
      events.push_back({stamp, id(random)});
    }
    ASSERT_TRUE(same(unpack(packed(events)), events)) << "robot " << robot;
  }
}

/// Messages of a type whose ages scatter by a share, with or without a header.
std::vector<Event> withAttributes(double scatter, double size_scatter, bool header) {
  std::mt19937_64 random(3);
  std::normal_distribution<> normal;
  std::vector<Event> events;
  for (int k = 0; k < 20000; ++k) {
    const double size = 2000 * std::exp(size_scatter * normal(random));
    Event event{1000000000000 + k * std::int64_t{6000000}, static_cast<core::EventId>(k % 30)};
    event.attributes.size = core::sizeClass(static_cast<std::uint64_t>(size));
    if (header) {
      event.attributes.step = core::Attributes::Step::kNext;
      event.attributes.age =
          core::ageClass(core::toNanoseconds(0.02 * std::exp(scatter * normal(random))));
    }
    events.push_back(event);
  }
  return events;
}

double bytesOfAttributes(const std::vector<Event>& events) {
  return static_cast<double>(packed(events).attributes.size()) /
         static_cast<double>(events.size());
}

TEST(PackedEvents, AttributesAreKeptInTwoBytesAtMost) {
  for (const double scatter : {0.0, 0.3, 3.0}) {
    const std::vector<Event> events = withAttributes(scatter, scatter, true);
    EXPECT_TRUE(same(unpack(packed(events)), events));
  }
  EXPECT_EQ(bytesOfAttributes({{1, 0}, {2, 0}}), 0) << "nothing is known";
  EXPECT_LT(bytesOfAttributes(withAttributes(0, 0, false)), 0.3);
  EXPECT_LT(bytesOfAttributes(withAttributes(0.2, 0, true)), 1.3);
  EXPECT_LT(bytesOfAttributes(withAttributes(3, 0.01, true)), 2);
}

TEST(PackedEvents, NeedLittleMoreThanTheBitsThatFollowNoRule) {
  std::mt19937_64 random(1);
  std::exponential_distribution<> delay(163e-9);  // 163 Hz
  std::vector<Event> events;
  std::int64_t stamp = 1;
  for (int k = 0; k < 20000; ++k) {
    stamp += static_cast<std::int64_t>(delay(random));
    events.push_back({stamp, static_cast<core::EventId>(random() % 24)});
  }
  // log2(e 1 s / 163 Hz) = 23.99 bits, and 5 bits of the id.
  const double bits = 8.0 * static_cast<double>(packed(events).packed.size());
  EXPECT_GT(bits / 20000, 28.9);
  EXPECT_LT(bits / 20000, 29.2);
}

TEST(PackedEvents, DamageEndsInAnErrorOrInOtherEvents) {
  std::vector<Event> events{{100, 1}, {250, 3}, {700, 2}, {701, 0}};
  events[1].attributes.size = core::sizeClass(7);
  const std::vector<std::function<void(EventLog&)>> changes{
      [](EventLog& bad) { bad.packed.pop_back(); },
      [](EventLog& bad) { bad.packed.push_back(0); },
      [](EventLog& bad) { bad.attributes.pop_back(); },
      [](EventLog& bad) { bad.attributes.push_back(0); },
      [](EventLog& bad) { bad.events = 4000000000; },  // asks for much memory
      [](EventLog& bad) { bad.delay_bits = 63; },
      [](EventLog& bad) { bad.id_bits = 33; }};
  for (std::size_t k = 0; k < changes.size(); ++k) {
    EventLog bad = packed(events);
    changes[k](bad);
    EXPECT_THROW(unpack(bad), std::invalid_argument) << k;
  }

  std::mt19937_64 random(3);
  for (int k = 0; k < 20000; ++k) {  // no crash, no endless loop
    EventLog any;
    any.first.sec = static_cast<std::uint32_t>(random());
    any.events = static_cast<std::uint32_t>(random() % 50);
    any.delay_bits = static_cast<std::uint8_t>(random() % 70);
    any.id_bits = static_cast<std::uint8_t>(random() % 40);
    any.packed.resize(random() % 40);
    for (std::uint8_t& byte : any.packed) {
      byte = static_cast<std::uint8_t>(random() % 3 == 0 ? 255 : random());
    }
    try {
      EXPECT_EQ(unpack(any).size(), any.events);
    } catch (const std::invalid_argument&) {
    }
  }
}

}  // namespace
}  // namespace self_awareness::ros1
