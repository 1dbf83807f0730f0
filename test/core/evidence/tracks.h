#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/evidence/explain/excess.h"
#include "core/evidence/explain/unusual.h"
#include "core/evidence/watch/upstream.h"
#include "recordings.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/limits/limits.h"
#include "self_awareness/core/verdict/source_graph.h"

/// Numbers of the tracks of a model: limits, shares of them, and what is unusual then.
namespace self_awareness::core::evidence {

inline void expectSameTracks(const std::vector<Track>& a, const std::vector<Track>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].channel, b[k].channel);
    EXPECT_EQ(a[k].to, b[k].to);
    EXPECT_EQ(a[k].from, b[k].from);
  }
}

/// No limit: the track is not judged.
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// One number for all tracks.
inline std::vector<double> allTracks(const Model& model, double number) {
  return std::vector<double>(model.tracks().size(), number);
}

inline Limits allLimits(const Model& model, double limit) {
  return {allTracks(model, limit), {}};
}

inline void expectSameLimits(const Limits& a, const Limits& b) {
  ASSERT_EQ(a.tracks.size(), b.tracks.size());
  for (std::size_t track = 0; track < a.tracks.size(); ++track) {
    EXPECT_TRUE(a.tracks[track] == b.tracks[track] ||
                (std::isnan(a.tracks[track]) && std::isnan(b.tracks[track])))
        << track;
  }
}

/// What is unusual where tracks have reached these shares of their limits.
inline std::vector<Excess> excessesOf(const std::shared_ptr<const Model>& model,
                                      const std::vector<double>& shares, const Scorer& scorer) {
  return Excesses(model).closeWindow(shares, scorer);
}

/// A scorer that heard each event type for the last time so long ago [ns], and has closed a
/// window.
/// @param now end of the window [ns]
inline Scorer heardLast(const std::shared_ptr<const Model>& model,
                        const std::vector<std::int64_t>& ages, std::int64_t now) {
  Scorer scorer(model, kWindow);
  Events last;
  for (EventId id = 0; id < ages.size(); ++id) {
    last.push_back({now - ages[id], id});
  }
  addAll(scorer, together({last}));
  scorer.closeWindow(now);
  return scorer;
}

/// The number of one track.
inline double& ofTrack(std::vector<double>& numbers, const Model& model,
                       const std::string& channel, EventId to, EventId from) {
  return numbers.at(indexOf(model.tracks(), channel, to, from));
}

inline double& ofTrack(std::vector<double>& numbers, const Model& model,
                       const std::string& channel, EventId id) {
  return ofTrack(numbers, model, channel, id, id);
}

/// A moment of a robot, as excuses and the explanation see it. Every limit of silence is 1.
struct Moment {
  Moment(const std::shared_ptr<const Model>& model, std::shared_ptr<const SourceGraph> graph)
      : causes(model, std::make_shared<Upstream>(model->components(), std::move(graph))),
        limits_of_silence(model->size(), kNone),
        may_be_silent(model->size(), false) {
    for (std::size_t track = 0; track < model->tracks().size(); ++track) {
      if (model->finding(track) == Finding::kSilent) {
        limits_of_silence[model->tracks()[track].to] = 0.5;
      }
    }
  }
  Unusual in(const std::vector<Excess>& excesses, const Scorer& scorer,
             const RecentEvents& events) {
    causes.closeWindow(excesses);
    return {excesses, scorer, events, causes, limits_of_silence, strangers, may_be_silent};
  }

  Causes causes;
  std::vector<double> limits_of_silence;
  std::map<std::string, std::int64_t> strangers;
  std::vector<bool> may_be_silent;
};

}  // namespace self_awareness::core::evidence
