// Whole robots: a model, its limits, and the detector on recordings of normal operation.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "recordings.h"
#include "self_awareness/core/evidence/judge.h"
#include "self_awareness/core/evidence/limits/cross_fit.h"
#include "self_awareness/core/evidence/limits/limits.h"
#include "self_awareness/core/verdict/detector.h"

namespace self_awareness::core::evidence {
namespace {

/// What is learned from two halves of a training and recordings for calibration.
class Learned {
 public:
  Learned(const std::vector<Events>& training, const std::vector<Events>& calibration,
          const std::vector<EventType>& types)
      : models_(watch(countsOf({training.at(0)}, types), countsOf({training.at(1)}, types))),
        limits_(limitsOf(training, calibration)) {}

  const Model& model() const { return *models_.model(); }
  const Limits& limits() const { return limits_; }

  /// Number of alarms that begin in a recording.
  int alarms(const Events& events) const {
    int alarms = 0;
    Detector detector(
        makeJudge(models_.model(), limits_, kWindow, std::make_shared<SourceGraph>()), kWindow, {},
        [&](const Verdict& verdict) { alarms += verdict.changed && verdict.alarm ? 1 : 0; });
    for (const Event& event : events) {
      detector.add(event);
    }
    detector.advance(events.back().stamp);
    return alarms;
  }

 private:
  Limits limitsOf(const std::vector<Events>& training, const std::vector<Events>& calibration) {
    LimitFinder finder(models_.model(), {kWindow, 5 * kSecond});
    const auto add = [&](const Events& events, const std::shared_ptr<const Model>& judging) {
      finder.startRecording(judging);
      for (const Event& event : events) {
        finder.add(event);
      }
    };
    for (const std::size_t half : {0U, 1U}) {
      add(training[half], models_.judging(half));
    }
    for (const Events& events : calibration) {
      add(events, models_.judging({}));
    }
    finder.finish();
    return finder.find().limits;
  }

  CrossFit models_;
  Limits limits_;
};

std::vector<EventType> typesOf(std::size_t number) {
  std::vector<EventType> types;
  for (std::size_t id = 0; id < number; ++id) {
    const std::string name = "/" + std::to_string(id);
    types.push_back({name, name + "/out", "T"});
  }
  return types;
}

// A start of a robot of exact timers, with phases of its own. Some have a chain of followers.
constexpr std::size_t kTimers = 8;
constexpr std::size_t kChains = 3;
const std::vector<EventType> kTimerTypes = typesOf(kTimers + kChains);

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

// A start of a robot with one component that comes irregularly, one that answers it, and others at
// random.
Events irregularRobot(unsigned seed, std::int64_t length) {
  const Events asked = irregular(kA, 0, length, 200 * kMillisecond, seed);
  return later(together({asked, answers(kB, asked, 20 * kMillisecond),
                         irregular(kC, 0, length, 50 * kMillisecond, seed + 100)}),
               static_cast<std::int64_t>(seed) * 2 * kStart);
}

TEST(Quiet, ExactTimersWithNewPhasesInEveryStartRaiseNoAlarm) {
  const Learned learned({exactTimers(1, 200 * kSecond), exactTimers(2, 200 * kSecond)},
                        {exactTimers(3, 300 * kSecond)}, kTimerTypes);
  for (unsigned seed = 10; seed < 30; ++seed) {
    EXPECT_EQ(learned.alarms(exactTimers(seed, 200 * kSecond)), 0) << seed;
  }
}

TEST(Quiet, ADeadTimerIsStillFound) {
  const Learned learned({exactTimers(1, 200 * kSecond), exactTimers(2, 200 * kSecond)},
                        {exactTimers(3, 300 * kSecond)}, kTimerTypes);
  for (EventId dead = 0; dead < kTimers; ++dead) {
    Events events = exactTimers(40 + dead, 60 * kSecond);
    const std::int64_t fault = events.front().stamp + 40 * kSecond;
    events.erase(std::remove_if(
                     events.begin(), events.end(),
                     [&](const Event& event) { return event.id == dead && event.stamp > fault; }),
                 events.end());
    EXPECT_EQ(learned.alarms(events), 1) << dead;
  }
}

TEST(Quiet, AModelRaisesNoAlarmOnItsOwnCalibrationRecordings) {
  for (unsigned seed = 1; seed < 30; seed += 4) {
    const std::vector<Events> timers{exactTimers(seed + 2, 60 * kSecond),
                                     exactTimers(seed + 3, 60 * kSecond)};
    const Learned exact({exactTimers(seed, 60 * kSecond), exactTimers(seed + 1, 60 * kSecond)},
                        timers, kTimerTypes);
    const std::vector<Events> others{irregularRobot(seed + 2, 60 * kSecond),
                                     irregularRobot(seed + 3, 60 * kSecond)};
    const Learned random(
        {irregularRobot(seed, 60 * kSecond), irregularRobot(seed + 1, 60 * kSecond)}, others,
        kTypes);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(exact.alarms(timers[k]), 0) << seed;
      EXPECT_EQ(random.alarms(others[k]), 0) << seed;
    }
  }
}

}  // namespace
}  // namespace self_awareness::core::evidence
