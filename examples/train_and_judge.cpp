// Events in, who is to blame out, without ROS and without Python: docs/embedding.md explains it.

#include <iostream>
#include <memory>

#include "self_awareness/core/learn.h"
#include "self_awareness/core/verdict/alarm.h"
#include "simulated_recording.h"

namespace core = self_awareness::core;

int main() {
  // 1. Learn from four recordings of normal operation, of 100 s each and ten minutes apart: of
  // four starts. The laser's scans reach the slam.
  core::SourceGraph graph;
  graph.connect("/laser", "/scan", "/slam");
  core::Learner learner(graph);
  for (const core::EventType& type : kEventTypes) {
    learner.intern(type);
  }
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    core::Recording recording{simulatedRecording(seed, 100, std::nullopt), "normal"};
    for (core::Event& event : recording.events) {
      event.stamp += seed * 600 * core::kNanosecondsPerSecond;
    }
    learner.add(recording);
  }
  const core::Model model = learner.learn();

  // 2. Judge another recording, in which the laser dies after 60 s.
  core::Alarms alarms;
  const auto print = [&](const core::Verdict& verdict) {
    alarms.add(verdict, model.window, model.vocabulary());
    if (verdict.alarm && verdict.changed) {
      const core::Alarm& alarm = *alarms.standing();
      std::cout << core::toString(alarm.kind) << ' ' << alarm.culprit << ", alarm at "
                << core::toSeconds(alarm.begin) << " s\n";
      for (const core::Suspect& suspect : alarm.suspects) {
        std::cout << suspect.component << ": " << suspect.reason.words << '\n';
      }
    }
  };
  core::Detector detector(model.makeJudge(), model.window, {}, print);
  for (const core::Event& event : simulatedRecording(5, 100, 60)) {
    detector.add(event);
  }
  detector.finish();
}
