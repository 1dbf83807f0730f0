// Whole robots: what is learned of them, and the detector on recordings of normal operation.

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "judged.h"

namespace self_awareness::core::evidence {
namespace {

// A start of a robot of exact timers, with phases of its own. Some have a chain of followers.
constexpr std::size_t kTimers = 8;
constexpr std::size_t kChains = 3;

Events exactTimers(unsigned seed, std::int64_t length) {
  static const std::vector<std::int64_t> kPeriods{10, 20, 50, 100, 100, 200, 500, 1000};  // [ms]
  std::mt19937 random(seed);
  std::normal_distribution<double> jitter(0, 0.3 * kMillisecond);
  std::uniform_real_distribution<double> phase(0, 1);
  Events events;
  for (std::size_t id = 0; id < kTimers; ++id) {
    const std::int64_t period = kPeriods[id] * kMillisecond;
    const auto first = static_cast<std::int64_t>(phase(random) * static_cast<double>(period));
    for (std::int64_t at = first; at < length; at += period) {
      const std::int64_t stamp = at + static_cast<std::int64_t>(jitter(random));
      events.push_back({stamp, static_cast<EventId>(id)});
      if (id >= kTimers - kChains - 1 && id < kTimers - 1) {
        const auto took = 8 * kMillisecond + static_cast<std::int64_t>(jitter(random));
        events.push_back({stamp + took, static_cast<EventId>(id + kChains + 1)});
      }
    }
  }
  return later(together({events}), static_cast<std::int64_t>(seed) * 2 * kStart);
}

core::Model learned() {
  return learnedFrom(numberedTypes(kTimers + kChains),
                     {exactTimers(1, 200 * kSecond), exactTimers(2, 200 * kSecond),
                      exactTimers(3, 300 * kSecond)});
}

/// Number of alarms that begin in a recording.
int alarmsIn(const core::Model& model, const Events& events) {
  int alarms = 0;
  judge(model.makeJudge(), events,
        [&](const Verdict& verdict) { alarms += verdict.changed && verdict.alarm ? 1 : 0; });
  return alarms;
}

TEST(Quiet, ExactTimersWithNewPhasesInEveryStartRaiseNoAlarm) {
  const core::Model model = learned();
  for (unsigned seed = 10; seed < 30; ++seed) {
    EXPECT_EQ(alarmsIn(model, exactTimers(seed, 200 * kSecond)), 0) << seed;
  }
}

TEST(Quiet, ADeadTimerIsStillFound) {
  const core::Model model = learned();
  for (EventId dead = 0; dead < kTimers; ++dead) {
    const Events usual = exactTimers(40 + dead, 60 * kSecond);
    const std::int64_t fault = usual.front().stamp + 40 * kSecond;
    const Events events = without(
        usual, [&](const Event& event) { return event.id == dead && event.stamp > fault; });
    EXPECT_EQ(alarmsIn(model, events), 1) << dead;
  }
}

}  // namespace
}  // namespace self_awareness::core::evidence
