#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "attributed.h"
#include "judged.h"
#include "self_awareness/core/evidence/limits/coverage.h"

/// Robots of two sources, from their events to the alarm, for the tests of the channels of
/// attributes.
namespace self_awareness::core::evidence {

constexpr std::int64_t kLength = 200 * kSecond;
constexpr std::int64_t kFault = 60 * kSecond;  // after the start of a recording

/// Two sources, the second of which is always healthy.
inline Events robot(const Source& source, unsigned seed, std::int64_t length = kLength) {
  const std::int64_t start = (seed + 1) * kStart;
  return together({messages(kA, start, start + length, source, seed),
                   messages(kB, start + 7 * kMillisecond, start + length, {}, seed + 100)});
}

/// Contents that change for minutes change always, so that recordings may be short.
inline Tuning withFrozen() {
  Tuning tuning;
  tuning.changing_time = 300;
  return tuning;
}

/// A model of recordings, each of a start of its own.
inline std::shared_ptr<const core::Model> learned(const std::vector<Events>& recordings,
                                                  const Tuning& tuning = withFrozen()) {
  return std::make_shared<core::Model>(learnedFrom({kTypes[kA], kTypes[kB]}, recordings, tuning));
}

/// Four starts of a robot.
/// @param start its events, by its seed
template <typename Start>
std::vector<Events> fourStarts(const Start& start) {
  return {start(0), start(1), start(2), start(3)};
}

inline std::shared_ptr<const core::Model> learned(const Source& source) {
  return learned(fourStarts([&](unsigned seed) { return robot(source, seed); }));
}

inline bool watches(const core::Model& model, const std::string& channel, EventId id = kA) {
  const std::size_t track = indexOf(model.watched.tracks, channel, id, id);
  return track < model.watched.tracks.size() && !std::isnan(model.limits()->tracks[track]);
}

/// What is not judged of the topics of a model.
inline std::vector<Coverage::Blind> blindIn(const core::Model& model) {
  std::vector<Coverage::Blind> all;
  for (const Coverage& of :
       coverageOf(Model(model.watched), *model.limits(), {}, model.window, false)) {
    all.insert(all.end(), of.blind.begin(), of.blind.end());
  }
  return all;
}

inline std::optional<Begun> alarmIn(const core::Model& model, const Events& events) {
  return alarmIn(model.makeJudge(), events);
}

/// Changes what all messages of the first source say.
template <typename Change>
std::vector<Events> recordingsWhere(Change change) {
  return fourStarts([&](unsigned seed) {
    Events events = robot({}, seed);
    std::size_t number = 0;
    for (Event& event : events) {
      if (event.id == kA) {
        change(event, number++);
      }
    }
    return events;
  });
}

}  // namespace self_awareness::core::evidence
