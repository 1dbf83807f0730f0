#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "self_awareness/core/stream/event.h"

/// The event types of a robot of three nodes. Their index is their id.
inline const std::vector<self_awareness::core::EventType> kEventTypes{
    {"/laser", "/scan", "sensor_msgs/LaserScan"},
    {"/slam", "/pose", "geometry_msgs/PoseStamped"},
    {"/battery", "/charge", "std_msgs/Float32"},
};

/// What this robot does: the laser sends 20 scans a second, a pose answers each of them after 14
/// to 28 ms, and the battery tells its charge three times a second, whatever the others do.
/// @param seconds how long the recording lasts, > 0
/// @param death when the laser dies [s], so that no scan is left to answer; none: it lives
/// @return events in the order of their stamps
inline std::vector<self_awareness::core::Event> simulatedRecording(unsigned seed, int seconds,
                                                                   std::optional<int> death) {
  constexpr std::int64_t kMillisecond = 1000000;
  std::mt19937 random(seed);
  // From `least` to less than twice that [ns]. Not by a distribution of the standard library: each
  // library has its own numbers.
  const auto around = [&random](std::int64_t least) {
    return least + static_cast<std::int64_t>(random()) % least;
  };
  const std::int64_t end = seconds * self_awareness::core::kNanosecondsPerSecond;
  const std::int64_t silent = death ? *death * self_awareness::core::kNanosecondsPerSecond : end;
  std::vector<self_awareness::core::Event> events;
  for (std::int64_t scan = 0; scan < silent; scan += around(34 * kMillisecond)) {
    events.push_back({scan, 0});
    events.push_back({scan + around(14 * kMillisecond), 1});
  }
  for (std::int64_t charge = 0; charge < end; charge += around(220 * kMillisecond)) {
    events.push_back({charge, 2});
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  return events;
}
