#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/evidence/watch/relation.h"

namespace self_awareness::core::evidence {

/// How soon faults of a component are found by a model's limits (docs/learn.md).
struct Coverage {
  /// What needs more starts than so many is not told.
  static constexpr std::size_t kMostStarts = 50;

  std::string component;
  /// Mean gap of the event type that comes most often [s]; 0: nothing came twice.
  double period = 0;
  /// Gaps of the event type that has most of them: with too few, nothing is judged.
  std::uint64_t gaps = 0;
  /// Longest time from its last event to the alarm, if it dies [s]; none: silence is not judged.
  std::optional<double> death_found_after;
  /// Longest time to the alarm, if it dies, while others ask it or go on that pause when it does
  /// [s]; none: nobody does.
  std::optional<double> found_when_asked;
  /// Whether its death would be found, but is accepted as normal (docs/live.md).
  bool accepted = false;
  /// How much later than usual it must answer, for a minute, so that it is found [s]; none: it is
  /// not found, however late.
  std::optional<double> late_answers;
  /// Starts of the robot after which that would be found, if it is not; 0: no number helps, or it
  /// is not known.
  std::size_t more_starts = 0;
  /// Whether that would be found already if the graph were known, and said that messages of the
  /// one that it answers reach it.
  bool graph_helps = false;

  /// What is not judged of a topic, or far later than of others of its component, though it looks
  /// as if it could be: "content of /fix: it repeated for 522 s in training".
  struct Blind {
    std::string about;
    std::string topic;
    std::string why;
  };
  std::vector<Blind> blind{};

  /// Whether its death is found at all.
  bool isWatched() const { return death_found_after.has_value() || found_when_asked.has_value(); }
};

/// How soon its death is found, in words: "9.5 s", "9.5 s, 0.6 s while it is needed" where that is
/// sooner, "0.6 s while it is needed", or nothing where it is not. Two digits are told.
/// @param unit after each number: " s", or nothing where the reader knows it
std::string foundAfter(const Coverage& coverage, const std::string& unit);

/// Which late answers of a component are found, in words: "from 60 ms", or with what: "after 2
/// more starts", "with the graph", "with the graph, or after 2 more starts"; empty: with nothing.
std::string lateAnswers(const Coverage& coverage);

/// Of all components of a model, in the order of Model::components().
/// @param limits of its tracks
/// @param relations by track; empty: not known
/// @param window length of a window [ns]
/// @param knows_graph whether the model knows who subscribes to what
/// @param may_be_silent by id: event types whose silence is accepted; empty: none
/// @throw std::invalid_argument unless there is a limit for each track
std::vector<Coverage> coverageOf(const Model& model, const Limits& limits,
                                 const std::vector<Relation>& relations, std::int64_t window,
                                 bool knows_graph, const std::vector<bool>& may_be_silent = {});

}  // namespace self_awareness::core::evidence
