#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "recordings.h"
#include "self_awareness/core/learn.h"
#include "self_awareness/core/verdict/detector.h"

/// Recordings that are learned from and judged, from their events to the verdicts.
namespace self_awareness::core::evidence {

/// What is learned from recordings, each of a start of its own.
inline core::Model learnedFrom(const std::vector<EventType>& types,
                               const std::vector<Events>& recordings, const Tuning& tuning = {}) {
  Learner::Parameters parameters;
  parameters.tuning = tuning;
  Learner learner(parameters, {});
  for (const EventType& type : types) {
    learner.intern(type);
  }
  for (const Events& events : recordings) {
    learner.add({events, ""});
  }
  core::Model model = learner.learn();
  EXPECT_TRUE(model.calibration) << learner.why();
  return model;
}

/// Judges a recording to its end; tells of every verdict.
template <typename OnVerdict>
void judge(std::unique_ptr<core::Judge> judge, const Events& events, OnVerdict onVerdict) {
  Detector detector(std::move(judge), kWindow, {}, onVerdict);
  addAll(detector, events);
  detector.finish();
}

/// The begin of an alarm.
struct Begun {
  std::int64_t time = 0;  // end of the window [ns]
  std::string evidence;
  std::vector<Suspect> suspects;
};

/// The first alarm of a recording.
inline std::optional<Begun> alarmIn(std::unique_ptr<core::Judge> judging, const Events& events) {
  std::optional<Begun> alarm;
  judge(std::move(judging), events, [&](const Verdict& verdict) {
    if (!alarm && verdict.alarm) {
      alarm = {verdict.window->start + kWindow, verdict.evidence, verdict.suspects};
    }
  });
  return alarm;
}

using Ids = std::vector<EventId>;

inline Ids idsOf(const std::vector<Suspect>& suspects) {
  Ids ids;
  ids.reserve(suspects.size());
  for (const Suspect& suspect : suspects) {
    ids.push_back(suspect.id);
  }
  return ids;
}

}  // namespace self_awareness::core::evidence
