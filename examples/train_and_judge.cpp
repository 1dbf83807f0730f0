// Events in, who is to blame out, without ROS and without Python: docs/embedding.md explains it.

#include <cstddef>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include "self_awareness/core/evidence/channel/watched.h"
#include "self_awareness/core/evidence/judge.h"
#include "self_awareness/core/evidence/limits/cross_fit.h"
#include "self_awareness/core/evidence/limits/limits.h"
#include "self_awareness/core/training.h"
#include "self_awareness/core/verdict/detector.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "simulated_recording.h"

namespace core = self_awareness::core;
namespace evidence = self_awareness::core::evidence;

int main() {
  // Four recordings of normal operation, of 100 s each and ten minutes apart: of four starts.
  std::vector<std::vector<core::Event>> recordings;
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    recordings.push_back(simulatedRecording(seed, 100, std::nullopt));
    for (core::Event& event : recordings.back()) {
      event.stamp += seed * 600 * core::kNanosecondsPerSecond;
    }
  }

  // 1. Training counts what the recordings show. Their places in the list serve as fingerprints.
  core::Training training({});
  for (const core::EventType& type : kEventTypes) {
    training.intern(type);
  }
  for (std::size_t fingerprint = 0; fingerprint < recordings.size(); ++fingerprint) {
    const std::vector<core::Event>& recording = recordings[fingerprint];
    const std::int64_t middle = recording[recording.size() / 2].stamp;
    training.startRecording({fingerprint, middle, std::nullopt, 0});
    for (const core::Event& event : recording) {
      training.add(event);
    }
  }
  const core::TrainingCounts counts = training.finish();

  // 2. The counts say what is worth watching, and what is usual. Who hears whom is a reason to
  // watch what two do together, and tells the root of a fault from its victims.
  const auto graph = std::make_shared<core::SourceGraph>();
  graph->connect("/laser", "/scan", "/slam");
  const evidence::CrossFit models(evidence::watch(counts.halves[0], counts.halves[1], *graph));

  // 3. Limits say what is too unusual. Who judges a recording has not learned from it.
  evidence::LimitFinder finder(models.model(), {}, *graph);
  for (std::size_t fingerprint = 0; fingerprint < recordings.size(); ++fingerprint) {
    finder.startRecording(models.judging(evidence::halfOf(fingerprint)));
    for (const core::Event& event : recordings[fingerprint]) {
      finder.add(event);
    }
    finder.finish();
  }
  const evidence::LimitFinder::Found found = finder.find();

  // 4. The detector judges another recording, in which the laser dies after 60 s.
  const auto print = [&models](const core::Verdict& verdict) {
    if (verdict.changed && verdict.alarm) {
      std::cout << "alarm at " << core::toSeconds(verdict.window->start) << " s\n";
      for (const core::Suspect& suspect : verdict.suspects) {
        std::cout << core::toString(models.model()->vocabulary().at(suspect.id)) << ": "
                  << suspect.reason.words << '\n';
      }
    }
  };
  core::Detector detector(
      evidence::makeJudge(models.model(), found.limits, core::kDefaultWindow, graph),
      core::kDefaultWindow, {}, print);
  for (const core::Event& event : simulatedRecording(5, 100, 60)) {
    detector.add(event);
  }
  detector.finish();
}
