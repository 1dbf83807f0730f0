#include "core/paper/blame.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

namespace self_awareness::core::paper {
namespace {

// Events that score less than this share of the expected score are named.
constexpr double kLowScore = 0.5;

struct SeenInWindow {
  std::size_t events = 0;
  double score_sum = 0;
  std::int64_t longest_gap = 0;
  bool unknown = false;
};

std::map<EventId, SeenInWindow> eventsByType(const Window& window,
                                             const std::vector<double>& scores) {
  std::map<EventId, SeenInWindow> seen;
  for (std::size_t i = 0; i < window.events.size(); ++i) {
    const ObservedEvent& observed = window.events[i];
    SeenInWindow& type = seen[observed.event.id];
    ++type.events;
    type.score_sum += scores.at(i);
    type.longest_gap = std::max(type.longest_gap, observed.gap.value_or(0));
    type.unknown = observed.unknown;
  }
  return seen;
}

Reason lowScore(double score, double usual) {
  Reason reason;
  reason.kind = Kind::kOutOfOrder;
  reason.unit = unit::kScore;
  reason.value = score;
  reason.usual = usual;
  char text[100];
  std::snprintf(text, sizeof text,
                "at unusual delays after the others: score %.3g, usually about %.3g", score,
                usual);
  reason.words = text;
  return reason;
}

}  // namespace

Blame::Blame(std::shared_ptr<const Model> model) : model_(std::move(model)) {
  const double bin_size = toSeconds(model_->binning().bin_size);
  usual_.resize(model_->size());
  for (EventId id = 0; id < model_->size(); ++id) {
    const Histogram& gaps = model_->gaps(id);
    Usual& usual = usual_[id];
    usual.gaps = gaps.total();
    usual.score = model_->expectedScore(id);
    if (!gaps.empty()) {
      usual.shortest = static_cast<double>(gaps.quantile(kUsualFrom)) * bin_size;
      usual.longest = static_cast<double>(gaps.quantile(kUsualTo) + 1) * bin_size;
    }
  }
}

Suspect Blame::suspectOf(EventId id) const {
  Suspect suspect;
  suspect.id = id;
  if (id < model_->size()) {
    const EventType& type = model_->vocabulary().at(id);
    suspect.component = componentOf(type.source, type.scope);
  }
  return suspect;
}

Reason Blame::silence(EventId id, double seconds, bool lasts) const {
  const Usual& usual = usual_[id];
  Reason reason;
  reason.kind = lasts ? Kind::kSilent : Kind::kLate;
  reason.unit = unit::kSeconds;
  reason.value = seconds;
  reason.lasted = seconds;
  reason.usual_shortest = usual.shortest;
  reason.usual_longest = usual.longest;
  char text[100];
  std::snprintf(text, sizeof text, "%s %.2f s, usually every %.3f to %.3f s",
                lasts ? "silent for" : "came after", seconds, usual.shortest, usual.longest);
  reason.words = text;
  return reason;
}

std::vector<Suspect> Blame::suspects(const Window& window, const std::vector<double>& scores,
                                     const std::vector<std::optional<std::int64_t>>& last_seen,
                                     std::int64_t end) const {
  std::map<EventId, SeenInWindow> seen = eventsByType(window, scores);
  std::vector<std::pair<double, Suspect>> overdue;  // by the logarithm of survival
  std::vector<std::pair<double, Suspect>> unknown;  // by the number of events, negative
  std::vector<std::pair<double, Suspect>> unusual;  // by the share of the expected score

  for (EventId id = 0; id < model_->size(); ++id) {
    if (!last_seen[id] || usual_[id].gaps < kFewestGaps) {
      continue;
    }
    const std::int64_t age = end - *last_seen[id];
    const auto in_window = seen.find(id);
    const std::int64_t gap = in_window == seen.end() ? 0 : in_window->second.longest_gap;
    const double log_survival = model_->logSurvival(id, std::max(age, gap));
    if (log_survival > kRareSilence) {
      continue;
    }
    Suspect suspect = suspectOf(id);
    suspect.reason = silence(id, toSeconds(std::max(age, gap)), age >= gap);
    overdue.emplace_back(log_survival, suspect);
    seen.erase(id);
  }
  for (const auto& [id, type] : seen) {
    Suspect suspect = suspectOf(id);
    if (type.unknown) {
      suspect.reason = strangerIn(type.events);
      suspect.abnormal = true;
      unknown.emplace_back(-static_cast<double>(type.events), suspect);
      continue;
    }
    const double score = type.score_sum / static_cast<double>(type.events);
    if (score < kLowScore * usual_[id].score) {
      suspect.reason = lowScore(score, usual_[id].score);
      unusual.emplace_back(score / usual_[id].score, suspect);
    }
  }

  std::vector<Suspect> ranked;
  for (auto* group : {&overdue, &unknown, &unusual}) {
    std::stable_sort(group->begin(), group->end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [rank, suspect] : *group) {
      if (ranked.size() < kMostSuspects) {
        ranked.push_back(suspect);
      }
    }
  }
  return ranked;
}

}  // namespace self_awareness::core::paper
