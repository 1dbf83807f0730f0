#include "self_awareness/core/evidence/limits/coverage.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/evidence/channel/channel.h"
#include "core/evidence/channel/channels.h"
#include "self_awareness/core/stream/event.h"
#include "self_awareness/core/verdict/persistence.h"

namespace self_awareness::core::evidence {
namespace {

// A silence that is found later is named if something else of its component is found so much
// sooner.
constexpr double kFoundLate = 60;  // [s]
constexpr double kFarLater = 10;

/// The fewest starts that a relation lacks, of those so far (0: of none) and one more.
std::size_t fewer(std::size_t so_far, const Relation& relation) {
  if (relation.starts_needed <= relation.starts) {
    return so_far;
  }
  const std::size_t lacks = relation.starts_needed - relation.starts;
  return so_far == 0 ? lacks : std::min(so_far, lacks);
}

/// Whether a relation would be watched if messages of the one reached the other.
bool wouldBeWatchedByGraph(const Relation& relation, double chance) {
  return !relation.watched && !relation.reaches && relation.starts > 0 &&
         (relation.irregular || byChance(relation) <= chance);
}

/// Two digits, without an exponent.
std::string rounded(double seconds, const std::string& unit) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.2g", seconds);
  char text[32];
  std::snprintf(text, sizeof text, "%g", std::strtod(digits, nullptr));
  return text + unit;
}

/// When a silence is found, that is beyond its limit [s]: it is looked at when a window ends, and
/// certain when the next one does.
double foundBySilence(double limit, std::int64_t window) {
  return limit + toSeconds(2 * window);
}

void addBlind(const Model& model, const Limits& limits, std::vector<Coverage>& coverages) {
  for (const Channel* channel : channels()) {
    if (channel->about().empty() || !model.tuning().isOn(channel->name())) {
      continue;
    }
    std::set<EventId> watched;
    std::set<EventId> judged;
    for (std::size_t number = 0; number < model.tracks().size(); ++number) {
      const Track& track = model.tracks()[number];
      if (track.channel == channel) {
        (std::isnan(limits.tracks[number]) ? watched : judged).insert(track.to);
      }
    }
    for (EventId id = 0; id < model.size(); ++id) {
      const bool is_known =
          static_cast<double>(model.statistics().type(id).gaps) >= model.tuning().fewest_gaps;
      const bool may_be = watched.count(id) > 0 || (is_known && channel->isOfAttributes());
      const std::string why = may_be && judged.count(id) == 0
                                  ? channel->whyNot(model.statistics(), id, model.tuning())
                                  : "";
      if (!why.empty()) {
        coverages[model.componentIndex(id)].blind.push_back(
            {channel->about(), model.vocabulary().at(id).scope, why});
      }
    }
  }
}

/// Names the topics of which a silence is found far later than the death of their component, which
/// is told by another one.
void addLate(const Model& model, const Limits& limits, std::int64_t window,
             const std::vector<bool>& may_be_silent, std::vector<Coverage>& coverages) {
  struct Found {
    double after = 0;  // [s]
    EventId id = 0;    // of its value that tells it first
  };
  std::map<std::pair<std::size_t, std::string>, Found> by_topic;
  for (std::size_t number = 0; number < model.tracks().size(); ++number) {
    const EventId id = model.tracks()[number].to;
    const bool accepted = id < may_be_silent.size() && may_be_silent[id];
    if (model.finding(number) == Finding::kSilent && !std::isnan(limits.tracks[number]) &&
        !accepted) {
      const Found found{foundBySilence(limits.tracks[number], window), id};
      Found& first =
          by_topic.try_emplace({model.componentIndex(id), model.vocabulary().at(id).scope}, found)
              .first->second;
      first = found.after < first.after ? found : first;
    }
  }
  for (const auto& [topic, found] : by_topic) {
    Coverage& of = coverages[topic.first];
    if (found.after > kFoundLate &&
        found.after > kFarLater * of.death_found_after.value_or(found.after)) {
      of.blind.push_back({"silence", topic.second,
                          "until " + rounded(found.after, " s") +
                              ", its longest pause in training was " +
                              rounded(toSeconds(model.longestGap(found.id)), " s")});
    }
  }
}

}  // namespace

std::string foundAfter(const Coverage& coverage, const std::string& unit) {
  const std::optional<double>& alone = coverage.death_found_after;
  const std::optional<double>& asked = coverage.found_when_asked;
  std::string words = alone ? rounded(*alone, unit) : "";
  if (asked && (!alone || *asked < *alone)) {
    words += (alone ? ", " : "") + rounded(*asked, unit) + " while it is needed";
  }
  return words;
}

std::string lateAnswers(const Coverage& coverage) {
  if (coverage.late_answers) {
    return "from " + rounded(1e3 * *coverage.late_answers, " ms");
  }
  std::string words = coverage.graph_helps ? "with the graph" : "";
  if (coverage.more_starts > 0 && coverage.more_starts <= Coverage::kMostStarts) {
    words += std::string(words.empty() ? "" : ", or ") + "after " +
             std::to_string(coverage.more_starts) + " more start" +
             (coverage.more_starts > 1 ? "s" : "");
  }
  return words;
}

std::vector<Coverage> coverageOf(const Model& model, const Limits& limits,
                                 const std::vector<Relation>& relations, std::int64_t window,
                                 bool knows_graph, const std::vector<bool>& may_be_silent) {
  if (limits.tracks.size() != model.tracks().size()) {
    throw std::invalid_argument("limits: one of each track is needed");
  }
  const double chance = model.tuning().chance;
  std::vector<Coverage> coverages(model.components().size());
  for (std::size_t k = 0; k < coverages.size(); ++k) {
    coverages[k].component = model.components()[k];
  }
  for (EventId id = 0; id < model.size(); ++id) {
    if (model.vocabulary().tellsMode(id)) {
      continue;  // it ticks, and nothing is sent
    }
    Coverage& of = coverages[model.componentIndex(id)];
    const double period = model.meanGap(id) * 1e-9;
    of.period =
        of.period > 0 && period > 0 ? std::min(of.period, period) : std::max(of.period, period);
    of.gaps = std::max(of.gaps, model.statistics().type(id).gaps);
  }
  for (std::size_t number = 0; number < model.tracks().size(); ++number) {
    const Track& track = model.tracks()[number];
    const double limit = limits.tracks[number];
    Coverage& of = coverages[model.componentIndex(track.to)];
    const Finding finding = model.finding(number);
    const bool accepted = track.to < may_be_silent.size() && may_be_silent[track.to];
    const bool judged = !std::isnan(limit);
    if (accepted && isAbsence(finding)) {
      of.accepted = of.accepted || judged;
    } else if (finding == Finding::kSilent && judged) {
      const double found = foundBySilence(limit, window);
      of.death_found_after = std::min(of.death_found_after.value_or(found), found);
    } else if (isAbsence(finding) && judged) {
      const double found = model.expectation(number).timeUntil(number, limit) * 1e-9 +
                           toSeconds(Persistence::Parameters().alarm_windows * window);
      of.found_when_asked = std::min(of.found_when_asked.value_or(found), found);
    } else if (finding == Finding::kBetween) {
      const std::optional<double> found =
          judged ? model.expectation(number).leastDelayFound(number, limit) : std::nullopt;
      if (found) {
        of.late_answers = std::min(of.late_answers.value_or(1e-9 * *found), 1e-9 * *found);
      }
      if (!judged && number < relations.size()) {
        of.more_starts = fewer(of.more_starts, relations[number]);
        of.graph_helps =
            of.graph_helps || (!knows_graph && wouldBeWatchedByGraph(relations[number], chance));
      }
    }
  }
  addBlind(model, limits, coverages);
  addLate(model, limits, window, may_be_silent, coverages);
  for (Coverage& of : coverages) {
    of.more_starts = of.late_answers ? 0 : of.more_starts;
    of.graph_helps = of.graph_helps && !of.late_answers;
    of.accepted = of.accepted && !of.isWatched();  // else another topic of it tells
  }
  return coverages;
}

}  // namespace self_awareness::core::evidence
