#include "synthetic_system.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace self_awareness::benchmarks {
namespace {

constexpr core::EventId kChain = 3;       // a timer, its answer, and the answer to that
constexpr double kShortestPeriod = 50e6;  // [ns]
constexpr double kLongestPeriod = 2e9;    // [ns]
constexpr double kJitter = 0.05;
constexpr std::int64_t kStart = 1600000000 * core::kNanosecondsPerSecond;

}  // namespace

SyntheticSystem::SyntheticSystem(std::size_t types, unsigned seed) : random_(seed), kinds_(types) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  for (core::EventId id = 0; id < types; ++id) {
    if (id % kChain == 0) {
      const double longer = std::pow(kLongestPeriod / kShortestPeriod, uniform(random));
      kinds_[id].period = static_cast<std::int64_t>(kShortestPeriod * longer);
      const auto phase = static_cast<std::int64_t>(uniform(random) * kLongestPeriod);
      due_.emplace(kStart + phase, id);
    } else {
      kinds_[id].delay = static_cast<std::int64_t>(2e6 + uniform(random) * 38e6);
    }
  }
}

core::Event SyntheticSystem::next() {
  const auto [stamp, id] = due_.top();
  due_.pop();
  if (kinds_[id].period > 0) {
    due_.emplace(stamp + jittered(kinds_[id].period), id);
  }
  const core::EventId answer = id + 1;
  if (answer < kinds_.size() && kinds_[answer].period == 0) {
    due_.emplace(stamp + jittered(kinds_[answer].delay), answer);
  }
  return {stamp, id};
}

std::vector<core::Event> SyntheticSystem::take(std::int64_t duration) {
  std::vector<core::Event> events{next()};
  while (events.back().stamp - events.front().stamp < duration) {
    events.push_back(next());
  }
  return events;
}

core::EventType SyntheticSystem::type(core::EventId id) {
  const std::string number = std::to_string(id);
  return {"/node_" + number, "/topic_" + number, "benchmark/Message"};
}

std::int64_t SyntheticSystem::jittered(std::int64_t duration) {
  std::normal_distribution<double> jitter(1, kJitter);
  return static_cast<std::int64_t>(static_cast<double>(duration) * std::max(jitter(random_), 0.1));
}

}  // namespace self_awareness::benchmarks
