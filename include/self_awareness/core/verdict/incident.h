#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/core/verdict/source_graph.h"
#include "self_awareness/core/verdict/suspect.h"

namespace self_awareness::core {

/// What incidents are made of: an alarm or a suspicion, with what is known of whom it names. A
/// recording that is looked at later knows more of it than its own reasons tell.
struct Occurrence {
  /// A suspect.
  struct Named {
    std::string component;
    bool abnormal = false;                     ///< it alone would be abnormal
    std::int64_t since = 0;                    ///< when it was named [ns]
    std::optional<std::int64_t> silent_since;  ///< [ns]; none: it was not silent, or not known
    Kind kind = Kind::kSilent;                 ///< what is wrong with it
    std::int64_t onset = 0;                    ///< since when [ns]; 0: not known
  };

  std::uint64_t id = 0;
  Alarm::Level level = Alarm::Level::kSuspicion;
  std::int64_t begin = 0;  ///< [ns]
  std::int64_t end = 0;    ///< [ns]; so far, if it is not over
  bool over = false;
  Kind kind = Kind::kSilent;
  std::string culprit;  ///< component; empty: there is none
  std::string reason;   ///< what happened, in a sentence
  std::vector<Named> named;
  std::vector<std::string> hosts;  ///< computers that fell silent as a whole
  std::vector<std::string> mode;   ///< components that stopped together while others go on
};

/// An alarm as its own reasons tell it.
Occurrence occurrenceOf(const Alarm& alarm);

/// All that one cause has done: alarms and suspicions, with their victims (docs/alarm.md).
struct Incident {
  /// Components that are kept in each of its lists, at most so many.
  static constexpr std::size_t kMostNamed = 100;
  /// Alarms and suspicions whose ids are kept, at most so many: the newest.
  static constexpr std::size_t kMostIds = 1000;

  std::uint64_t id = 0;    ///< of its first alarm; of its first suspicion if there is no alarm
  std::uint64_t main = 0;  ///< id of the longest one that blames the cause, alarms first
  std::uint64_t last = 0;  ///< id of the last one
  Alarm::Level level = Alarm::Level::kSuspicion;  ///< a suspicion: there were near misses only
  Kind kind = Kind::kSilent;                      ///< what is wrong, as the main one says
  std::string cause;                              ///< component; empty: nobody is to blame
  std::string reason;                             ///< the sentence of the main one
  /// Failed at once with it, and do not need its messages; of a new mode: all that stopped, if
  /// they are known.
  std::vector<std::string> together;
  /// Are named, and need messages of these or of others, by the graph.
  std::vector<std::string> victims;
  std::vector<std::string> others;  ///< are named besides
  std::vector<std::string> hosts;   ///< that fell silent as a whole: they are the cause
  std::int64_t opened = 0;          ///< begin of the one that `id` is of [ns]
  std::int64_t grown = 0;           ///< when it was raised last, or named a further component [ns]
  std::int64_t end = 0;             ///< of the last one, so far if it is not over [ns]
  bool over = false;
  bool unknown = false;            ///< over for the monitor, which ended while it was open
  std::uint32_t alarms = 0;        ///< how often it was raised
  std::uint32_t near_misses = 0;   ///< episodes of suspicions that became no alarm
  std::int64_t main_duration = 0;  ///< of the main one [ns]
  std::vector<std::uint64_t> ids;  ///< of its alarms and suspicions, in the order of time
};

/// Folds alarms and suspicions into incidents, one after the other, live and of a recording
/// alike: those that follow each other soon and name somebody in common are one episode, and
/// episodes of one cause are one incident.
class Incidents {
 public:
  /// An alarm that begins so long after the one before may be of its episode [ns].
  static constexpr std::int64_t kJoined = 5'000'000'000;
  /// Who falls silent within so long of the cause failed together with it [ns].
  static constexpr std::int64_t kAtOnce = 1'000'000'000;

  /// @param repeats_within an episode that begins so long [ns] after the last one of its cause
  /// belongs to the same incident
  /// @param most incidents that are kept: then near misses make room, and the oldest ones
  Incidents(std::int64_t repeats_within, std::size_t most);

  /// Takes in an alarm or a suspicion, or how the last one has changed since. Another id ends
  /// the last one: no two stand at the same time.
  /// @param graph whose messages reach whom
  void add(const Occurrence& occurrence, const SourceGraph& graph);
  /// Goes on with incidents of before the start; to be called first.
  void restore(std::vector<Incident> incidents) { state_.past = std::move(incidents); }
  /// The incidents in the order in which they were opened.
  /// @param graph whose messages reach whom
  std::vector<Incident> list(const SourceGraph& graph) const;

 private:
  struct Episode {
    Incident incident;
    std::set<std::string> named;  // by all of its alarms and suspicions
  };
  /// What is known up to an alarm, or with it.
  struct State {
    std::vector<Incident> past;
    std::optional<Episode> episode;  // the last one, which may go on
  };

  void take(State& state, const Occurrence& occurrence, const SourceGraph& graph) const;
  void merge(std::vector<Incident>& past, const Incident& episode, const SourceGraph& graph) const;

  std::int64_t repeats_within_;
  std::size_t most_;
  State state_;
  std::optional<Occurrence> open_;  // the last one, which may still change
};

}  // namespace self_awareness::core
