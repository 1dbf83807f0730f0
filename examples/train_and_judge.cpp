// Events in, who is to blame out, without ROS and without Python: docs/library.md explains it.

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "self_awareness/core/learn.h"
#include "self_awareness/core/verdict/alarm.h"

namespace core = self_awareness::core;

// A robot of three nodes. The index of an event type is its id.
const std::vector<core::EventType> kEventTypes{
    {"/laser", "/scan", "sensor_msgs/LaserScan"},
    {"/slam", "/pose", "geometry_msgs/PoseStamped"},
    {"/battery", "/charge", "std_msgs/Float32"},
};

// What it does for 100 s: the laser sends 20 scans a second, a pose answers each of them after 14
// to 28 ms, and the battery tells its charge three times a second, whatever the others do.
core::Recording recordingOf(unsigned start, std::int64_t laser_dies_after = 100) {
  constexpr std::int64_t kMillisecond = 1000000;
  std::mt19937 random(start);
  const auto around = [&random](std::int64_t least) {  // from it to less than twice that [ns]
    return least + static_cast<std::int64_t>(random()) % least;
  };
  core::Recording recording{{}, "start " + std::to_string(start)};
  const std::int64_t silent = laser_dies_after * core::kNanosecondsPerSecond;
  for (std::int64_t scan = 0; scan < silent; scan += around(34 * kMillisecond)) {
    recording.events.push_back({scan, 0});
    recording.events.push_back({scan + around(14 * kMillisecond), 1});
  }
  const std::int64_t end = 100 * core::kNanosecondsPerSecond;
  for (std::int64_t charge = 0; charge < end; charge += around(220 * kMillisecond)) {
    recording.events.push_back({charge, 2});
  }
  std::stable_sort(recording.events.begin(), recording.events.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  for (core::Event& event : recording.events) {  // one start every ten minutes
    event.stamp += start * 600 * core::kNanosecondsPerSecond;
  }
  return recording;
}

int main() {
  core::SourceGraph graph;
  graph.connect("/laser", "/scan", "/slam");
  core::Learner learner(graph);
  for (const core::EventType& type : kEventTypes) {
    learner.intern(type);
  }
  for (const unsigned start : {1U, 2U, 3U, 4U}) {
    learner.add(recordingOf(start));
  }
  core::Model model = learner.learn();

  core::Calibrator calibrator(model, {});
  calibrator.merge(model.findings);
  calibrator.addHeldOut(recordingOf(5));
  model.calibration = calibrator.find();

  const core::Recording recording = recordingOf(6, 60);  // the laser dies after 60 s
  core::Alarms alarms;
  const auto print = [&](const core::Verdict& verdict) {
    alarms.add(verdict, model.window, model.vocabulary());
    if (verdict.alarm && verdict.changed) {
      const core::Alarm& alarm = *alarms.standing();
      std::cout << core::toString(alarm.kind) << ' ' << alarm.culprit << ", alarm at "
                << core::toSeconds(alarm.begin - recording.events.front().stamp) << " s\n";
      for (const core::Suspect& suspect : alarm.suspects) {
        std::cout << suspect.component << ": " << suspect.reason.words << '\n';
      }
    }
  };
  core::Detector detector(model.makeJudge(), model.window, {}, print);
  for (const core::Event& event : recording.events) {
    detector.add(event);
  }
  detector.finish();
}
