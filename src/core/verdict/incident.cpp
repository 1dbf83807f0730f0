#include "self_awareness/core/verdict/incident.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "self_awareness/core/verdict/dependents.h"
#include "self_awareness/core/verdict/sentence.h"

namespace self_awareness::core {
namespace {

using Level = Alarm::Level;

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether two are about the same: kind and computers tell, where nobody is to blame.
template <typename First, typename Second>
bool sameCause(const First& first, const std::string& first_cause, const Second& second,
               const std::string& second_cause) {
  return first_cause == second_cause &&
         (!first_cause.empty() || (first.kind == second.kind && first.hosts == second.hosts));
}

std::optional<std::int64_t> silentSince(const Suspect& suspect) {
  return isSilence(suspect.reason.kind) && suspect.onset > 0 ? std::optional(suspect.onset)
                                                             : std::nullopt;
}

bool atOnce(const Occurrence::Named& first, const Occurrence::Named& other, bool graph_is_known) {
  if (first.silent_since || other.silent_since) {
    return first.silent_since && other.silent_since &&
           std::abs(*other.silent_since - *first.silent_since) <= Incidents::kAtOnce;
  }
  if (first.kind == Kind::kStranger || other.kind != first.kind) {
    return other.kind == first.kind;
  }
  // Only the graph tells victims then; whose input loses messages loses none itself.
  return (graph_is_known || first.kind == Kind::kLossy) && other.abnormal &&
         std::abs(other.onset - first.onset) <= Incidents::kJoined;
}

/// Who failed at once with the culprit, and does not need its messages.
std::vector<std::string> togetherWith(const Occurrence& main, const SourceGraph& graph) {
  const auto first = std::find_if(main.named.begin(), main.named.end(), [&](const auto& named) {
    return named.component == main.culprit;
  });
  std::vector<std::string> together = main.mode;
  together.resize(std::min(together.size(), Incident::kMostNamed));
  if (main.culprit.empty() || first == main.named.end()) {
    return together;
  }
  const std::set<std::string> dependent = dependentsOf(graph, main.culprit);
  for (const Occurrence::Named& named : main.named) {
    if (together.size() < Incident::kMostNamed && named.component != main.culprit &&
        dependent.count(named.component) == 0 && !contains(together, named.component) &&
        atOnce(*first, named, !graph.empty())) {
      together.push_back(named.component);
    }
  }
  return together;
}

/// Divides those that are named into victims and others: who needs another one that is named
/// before it is no fault of its own, either.
void divide(std::vector<std::string> named, const SourceGraph& graph, Incident& incident) {
  std::set<std::string> reached;
  const auto reach = [&](const std::string& cause) {
    reached = dependentsOf(graph, cause, std::move(reached));
  };
  std::vector<std::string> causes = incident.together;
  if (!incident.cause.empty()) {
    causes.insert(causes.begin(), incident.cause);
  }
  std::for_each(causes.begin(), causes.end(), reach);
  incident.victims.clear();
  incident.others.clear();
  for (std::string& name : named) {
    const bool is_victim = reached.count(name) > 0;
    std::vector<std::string>& list = is_victim ? incident.victims : incident.others;
    if (name.empty() || contains(causes, name) || contains(list, name)) {
      continue;
    }
    if (!is_victim) {
      reach(name);
    }
    if (list.size() < Incident::kMostNamed) {
      list.push_back(std::move(name));
    }
  }
}

std::vector<std::string> namedIn(const Incident& incident) {
  std::vector<std::string> named = incident.together;
  named.insert(named.end(), incident.others.begin(), incident.others.end());
  named.insert(named.end(), incident.victims.begin(), incident.victims.end());
  return named;
}

void addIds(const std::vector<std::uint64_t>& ids, Incident& incident) {
  incident.ids.insert(incident.ids.end(), ids.begin(), ids.end());
  if (incident.ids.size() > Incident::kMostIds) {
    incident.ids.erase(incident.ids.begin(), incident.ids.end() - Incident::kMostIds);
  }
}

/// An incident of nothing but this.
Incident begin(const Occurrence& occurrence) {
  Incident incident;
  incident.id = incident.main = occurrence.id;
  incident.level = occurrence.level;
  incident.kind = occurrence.kind;
  incident.cause = occurrence.culprit;
  incident.hosts = occurrence.hosts;
  incident.reason = occurrence.reason;
  incident.opened = incident.grown = occurrence.begin;
  incident.main_duration = occurrence.end - occurrence.begin;
  (occurrence.level == Level::kAlarm ? incident.alarms : incident.near_misses) = 1;
  return incident;
}

/// Whether `main` is a better one than that which an incident has.
bool isBetterMain(const Incident& incident, Level level, std::int64_t duration) {
  return std::pair(level == Level::kAlarm, duration) >
         std::pair(incident.level == Level::kAlarm, incident.main_duration);
}

/// Takes an alarm or a suspicion of the same episode in.
void extend(Incident& episode, const Occurrence& occurrence, const SourceGraph& graph) {
  const bool is_first = episode.ids.empty();
  const bool became_alarm = occurrence.level > episode.level;
  if (became_alarm) {  // before it, less was known, also of who is to blame
    const std::vector<std::uint64_t> ids = std::move(episode.ids);
    episode = begin(occurrence);
    episode.ids = ids;
  } else if (!is_first && occurrence.level == Level::kAlarm) {
    ++episode.alarms;
    episode.grown = std::max(episode.grown, occurrence.begin);
  }
  addIds({occurrence.id}, episode);
  episode.last = occurrence.id;
  episode.over = occurrence.over;
  episode.end = is_first ? occurrence.end : std::max(episode.end, occurrence.end);
  const bool same_cause = sameCause(episode, episode.cause, occurrence, occurrence.culprit);
  const std::int64_t duration = occurrence.end - occurrence.begin;
  std::vector<std::string> named = namedIn(episode);
  if (is_first || became_alarm ||
      (same_cause && isBetterMain(episode, occurrence.level, duration))) {
    episode.main = occurrence.id;
    episode.main_duration = duration;
    episode.kind = occurrence.kind;
    episode.reason = occurrence.reason;
    episode.together = togetherWith(occurrence, graph);
  }
  if (occurrence.level == episode.level) {
    for (const Occurrence::Named& each : occurrence.named) {
      if (each.component != episode.cause && !contains(named, each.component)) {
        named.push_back(each.component);
        episode.grown = std::max(episode.grown, each.since);
      }
    }
  }
  divide(std::move(named), graph, episode);
}

}  // namespace

Occurrence occurrenceOf(const Alarm& alarm) {
  Occurrence occurrence;
  occurrence.id = alarm.id;
  occurrence.level = alarm.level;
  occurrence.begin = alarm.begin;
  occurrence.end = alarm.end;
  occurrence.over = alarm.over;
  occurrence.kind = alarm.kind;
  occurrence.culprit = alarm.culprit;
  occurrence.reason = sentence(alarm);
  if (alarm.silent) {
    occurrence.hosts = alarm.silent->hosts;
    if (alarm.kind == Kind::kNewMode) {
      occurrence.mode = alarm.silent->components;
    }
  }
  for (const std::vector<Suspect>* suspects : {&alarm.suspects, &alarm.later}) {
    for (const Suspect& suspect : *suspects) {
      occurrence.named.push_back({suspect.component, suspect.abnormal, suspect.since,
                                  silentSince(suspect), suspect.reason.kind, suspect.onset});
    }
  }
  return occurrence;
}

Incidents::Incidents(std::int64_t repeats_within, std::size_t most)
    : repeats_within_(repeats_within), most_(most) {}

void Incidents::add(const Occurrence& occurrence, const SourceGraph& graph) {
  if (open_ && open_->id != occurrence.id) {
    open_->over = true;
    open_->end = std::max(open_->end, occurrence.begin);
    take(state_, *open_, graph);
  }
  open_ = occurrence;
  if (occurrence.over) {
    take(state_, occurrence, graph);
    open_.reset();
  }
}

std::vector<Incident> Incidents::list(const SourceGraph& graph) const {
  State state = state_;
  if (open_) {
    take(state, *open_, graph);
  }
  if (state.episode) {
    merge(state.past, state.episode->incident, graph);
  }
  return state.past;
}

void Incidents::take(State& state, const Occurrence& occurrence, const SourceGraph& graph) const {
  std::set<std::string> named;
  for (const Occurrence::Named& each : occurrence.named) {
    named.insert(each.component);
  }
  std::optional<Episode>& episode = state.episode;
  const bool goes_on = episode && occurrence.begin - episode->incident.end <= kJoined &&
                       std::any_of(named.begin(), named.end(), [&](const std::string& name) {
                         return episode->named.count(name) > 0;
                       });
  if (episode && !goes_on) {
    merge(state.past, episode->incident, graph);
    episode.reset();
  }
  if (!episode) {
    episode = Episode{begin(occurrence), {}};
  }
  extend(episode->incident, occurrence, graph);
  for (const std::string& name : named) {
    if (episode->named.size() < Incident::kMostNamed) {
      episode->named.insert(name);
    }
  }
}

void Incidents::merge(std::vector<Incident>& past, const Incident& episode,
                      const SourceGraph& graph) const {
  const auto found = std::find_if(past.rbegin(), past.rend(), [&](const Incident& incident) {
    return incident.last == episode.ids.front() ||
           (sameCause(incident, incident.cause, episode, episode.cause) &&
            (!incident.over || episode.opened - incident.end <= repeats_within_));
  });
  if (found == past.rend()) {
    past.push_back(episode);
    if (past.size() > most_) {
      const auto near_miss = std::find_if(
          past.begin(), past.end() - 1,
          [](const Incident& incident) { return incident.level == Level::kSuspicion; });
      past.erase(near_miss == past.end() - 1 ? past.begin() : near_miss);
    }
    return;
  }
  Incident merged = *found;
  const bool resumed = merged.last == episode.ids.front();
  if (episode.level > merged.level) {
    merged = episode;
    merged.ids = found->ids;
    merged.near_misses = found->near_misses;
  } else {
    merged.near_misses += resumed ? 0 : episode.near_misses;
    merged.alarms += episode.alarms - (resumed && episode.alarms > 0 ? 1 : 0);
  }
  if (episode.level == merged.level) {
    std::vector<std::string> named = namedIn(merged);
    if (isBetterMain(merged, episode.level, episode.main_duration)) {
      merged.main = episode.main;
      merged.main_duration = episode.main_duration;
      merged.kind = episode.kind;
      merged.reason = episode.reason;
      merged.together = episode.together;
    }
    const std::vector<std::string> further = namedIn(episode);
    named.insert(named.end(), further.begin(), further.end());
    merged.grown = resumed ? merged.grown : std::max(merged.grown, episode.grown);
    divide(std::move(named), graph, merged);
  }
  merged.last = episode.last;
  merged.over = episode.over;
  merged.unknown = episode.unknown;
  merged.end = std::max(merged.end, episode.end);
  addIds(episode.ids, merged);
  *found = std::move(merged);
}

}  // namespace self_awareness::core
