#include "core/evidence/blame.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace self_awareness::core::evidence {
namespace {

// Evidence below this share of its limit does not say who is involved.
constexpr double kLeastShare = 0.3;
// Of one track, no more than this share of its limit counts.
constexpr double kMostShare = 2;
// When a victim's evidence passes its limit, the root's may still be on the way.
constexpr double kNearLimit = 0.75;
// Of an unusual delay between two event types, the later one is a little more to blame.
constexpr double kShareOfEarlier = 0.9;

Suspect unknown(EventId id, const Window& window) {
  Suspect suspect;
  suspect.id = id;
  suspect.abnormal = true;
  suspect.reason = Suspect::Reason::kUnknown;
  suspect.events = static_cast<std::size_t>(
      std::count_if(window.events.begin(), window.events.end(),
                    [id](const ObservedEvent& other) { return other.event.id == id; }));
  return suspect;
}

}  // namespace

Blame::Blame(std::shared_ptr<const Model> model, std::shared_ptr<const SourceGraph> graph)
    : model_(std::move(model)), graph_(std::move(graph)) {}

std::vector<Suspect> Blame::suspects(const std::vector<double>& shares, const Scorer& scorer,
                                     const Hindsight& hindsight, const Window& window) const {
  const Reasons reasons(scorer, hindsight);
  std::vector<Candidate> candidates = silent(shares, reasons);
  const std::vector<Candidate> others = unusual(shares, reasons);
  candidates.insert(candidates.end(), others.begin(), others.end());

  std::vector<Suspect> suspects;
  std::set<EventId> named;
  std::set<std::string> components;
  const auto add = [&](const Candidate& candidate) {
    Suspect suspect = reasons.of(candidate.track);
    suspect.component = component(suspect.id);
    suspect.abnormal = shares[candidate.track] > 1;
    components.insert(suspect.component);
    suspects.push_back(std::move(suspect));
  };
  for (const Candidate& candidate : candidates) {
    if (suspects.size() < kMostSuspects && named.insert(toOf(candidate)).second) {
      add(candidate);
    }
  }
  for (const ObservedEvent& observed : window.events) {
    if (observed.unknown && suspects.size() < kMostSuspects &&
        named.insert(observed.event.id).second) {
      suspects.push_back(unknown(observed.event.id, window));
    }
  }
  for (const Candidate& candidate : candidates) {
    if (shares[candidate.track] > 1 && components.count(component(toOf(candidate))) == 0) {
      add(candidate);
    }
  }
  return suspects;
}

std::vector<Blame::Candidate> Blame::silent(const std::vector<double>& shares,
                                            const Reasons& reasons) const {
  std::set<EventId> missing;
  std::map<EventId, std::size_t> unanswered;  // tracks
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const Channel channel = model_->tracks()[track].channel;
    if (shares[track] > kNearLimit && channel == Channel::kDeadline) {
      unanswered.emplace(model_->tracks()[track].to, track);
    }
    if (shares[track] > kNearLimit &&
        (channel == Channel::kOverdue || channel == Channel::kAnswer)) {
      missing.insert(model_->tracks()[track].to);
    }
  }
  std::vector<Candidate> candidates;
  for (const EventId id : missing) {
    const double survival = logSurvival(id, reasons);
    if (survival < kRareSilence) {
      candidates.push_back({trackOfSilence(id, shares), survival});
    }
  }
  for (const auto& [id, track] : unanswered) {
    const double survival = logSurvival(id, reasons);
    if (missing.count(id) == 0 || survival >= kRareSilence) {
      candidates.push_back({track, std::min(survival, kRareSilence)});
    }
  }
  return rootFirst(std::move(candidates));
}

// Upstream before downstream is no total order: the candidate with the fewest others upstream is
// next. Sources are compared, not candidates: when a whole robot falls silent, every event type is
// a candidate, but there are few components.
std::vector<Blame::Candidate> Blame::rootFirst(std::vector<Candidate> candidates) const {
  std::stable_sort(candidates.begin(), candidates.end(), likelier);
  std::map<std::string, std::vector<std::size_t>> by_component;  // indexes of candidates
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    by_component[component(toOf(candidates[i]))].push_back(i);
  }
  std::vector<std::size_t> upstream(candidates.size(), 0);  // number of those left that are
  std::map<std::string, std::vector<std::size_t>> downstream;
  for (const auto& [source, members] : by_component) {
    for (const auto& [other, victims] : by_component) {
      if (graph_->isUpstream(source, other)) {
        downstream[source].insert(downstream[source].end(), victims.begin(), victims.end());
        for (const std::size_t victim : victims) {
          upstream[victim] += members.size();
        }
      }
    }
  }
  std::vector<Candidate> ordered;
  std::vector<std::size_t> left(candidates.size());
  std::iota(left.begin(), left.end(), 0);
  while (!left.empty()) {
    const auto root =
        std::min_element(left.begin(), left.end(),
                         [&](std::size_t a, std::size_t b) { return upstream[a] < upstream[b]; });
    ordered.push_back(candidates[*root]);
    for (const std::size_t victim : downstream[component(toOf(candidates[*root]))]) {
      --upstream[victim];
    }
    left.erase(root);
  }
  return ordered;
}

std::vector<Blame::Candidate> Blame::unusual(const std::vector<double>& shares,
                                             const Reasons& reasons) const {
  struct Involved {
    double sum = 0;
    std::size_t track = 0;  // with the largest share
    double largest = 0;
    bool own = false;  // something is wrong with it, whatever the others do
  };
  std::map<std::string, Involved> components;
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const auto& [channel, to, from] = model_->tracks()[track];
    if (shares[track] < kLeastShare || channel == Channel::kSlowDelay ||
        // An age that is usual has some share of its limit, too.
        (channel == Channel::kOverdue && logSurvival(to, reasons) >= kRareSilence)) {
      continue;
    }
    const double share = std::min(shares[track], kMostShare);
    Involved& later = components[component(to)];
    later.sum += share;
    later.own |= shares[track] > kNearLimit && channel != Channel::kOverdue &&
                 (channel != Channel::kDelay || from == to);
    if (share > later.largest) {
      later.largest = share;
      later.track = track;
    }
    if (channel == Channel::kDelay && component(from) != component(to)) {
      components[component(from)].sum += kShareOfEarlier * share;
    }
  }
  std::vector<Candidate> roots;
  std::vector<Candidate> others;
  for (const auto& [name, involved] : components) {
    if (involved.largest > 0) {
      (involved.own ? roots : others).push_back({involved.track, -involved.sum});
    }
  }
  roots = rootFirst(std::move(roots));
  std::stable_sort(others.begin(), others.end(), likelier);
  roots.insert(roots.end(), others.begin(), others.end());
  return roots;
}

double Blame::logSurvival(EventId id, const Reasons& reasons) const {
  return model_->logSurvival(id, reasons.age(id));
}

// Its age, if that alone is abnormal; else what is nearer to its limit: at half its rate, say, its
// age may be rare as well, but that is not what is wrong.
std::size_t Blame::trackOfSilence(EventId id, const std::vector<double>& shares) const {
  std::size_t most = 0;
  double largest = -1;
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const Channel channel = model_->tracks()[track].channel;
    if (model_->tracks()[track].to != id ||
        (channel != Channel::kOverdue && channel != Channel::kFewer &&
         channel != Channel::kAnswer)) {
      continue;
    }
    if (channel == Channel::kOverdue && shares[track] > 1) {
      return track;
    }
    if (shares[track] > largest) {
      largest = shares[track];
      most = track;
    }
  }
  return most;
}

const std::string& Blame::component(EventId id) const {
  const EventType& type = model_->vocabulary().at(id);
  return componentOf(type.source, type.scope);
}

}  // namespace self_awareness::core::evidence
