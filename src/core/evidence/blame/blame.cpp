#include "core/evidence/blame/blame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/evidence/blame/root_first.h"
#include "core/evidence/blame/strangers.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::size_t kMostLookedAt = 4 * kMostSuspects;

}  // namespace

Blame::Blame(std::shared_ptr<const Model> model, std::shared_ptr<const Upstream> upstream)
    : model_(std::move(model)),
      upstream_(std::move(upstream)),
      followers_(model_),
      tuning_(model_->tuning()),
      rare_silence_(std::log(tuning_.rare_silence)) {}

std::vector<Suspect> Blame::suspects(const std::vector<double>& shares, const Scorer& scorer,
                                     const RecentEvents& events, const Window& window) const {
  const Followers::Leads leads = followers_.leads(shares);
  std::vector<Candidate> candidates = silent(shares, scorer, events, leads);
  std::vector<Candidate> others = unusual(shares, scorer, events, leads);
  const auto roots = rootsOfSilence(candidates, others, scorer, events, leads);
  candidates.insert(candidates.begin(), others.begin(), roots);
  candidates.insert(candidates.end(), roots, others.end());

  std::vector<Suspect> suspects;
  std::set<EventId> named;
  std::set<std::string> components;
  const auto add = [&](const Candidate& candidate) {
    Suspect suspect = suspectOf(candidate.track, scorer, events);
    suspect.component = model_->component(suspect.id);
    suspect.abnormal = candidate.abnormal;
    if (!suspect.abnormal && isUsual(suspect)) {
      return;
    }
    named.insert(suspect.id);
    components.insert(suspect.component);
    suspects.push_back(std::move(suspect));
  };
  std::size_t looked_at = 0;  // to say why takes time
  for (const Candidate& candidate : candidates) {
    if (suspects.size() < kMostSuspects && looked_at < kMostLookedAt &&
        named.count(toOf(candidate)) == 0) {
      add(candidate);
      ++looked_at;
    }
  }
  addUnknown(window, suspects);
  for (const Candidate& candidate : candidates) {
    if (candidate.abnormal && components.count(model_->component(toOf(candidate))) == 0) {
      add(candidate);
    }
  }
  return suspects;
}

std::vector<Blame::Candidate> Blame::silent(const std::vector<double>& shares,
                                            const Scorer& scorer, const RecentEvents& events,
                                            const Followers::Leads& leads) const {
  std::map<EventId, std::size_t> missing;     // tracks
  std::map<EventId, std::size_t> unanswered;  // the same
  for (std::size_t track = 0; track < shares.size(); ++track) {
    if (shares[track] > tuning_.near_limit && isAbsence(model_->finding(track))) {
      (model_->finding(track) == Finding::kSilent ? missing : unanswered)
          .emplace(model_->tracks()[track].to, track);
    }
  }
  std::vector<Candidate> candidates;
  const auto add = [&](EventId id, std::size_t track) {
    candidates.push_back(
        {track, std::min(logSurvival(id, scorer), rare_silence_), false, shares[track] > 1});
  };
  for (const auto& [id, track] : missing) {
    if (!isUsualAge(track, shares, scorer)) {
      add(id, trackOfSilence(id, shares, scorer, events));
      unanswered.erase(id);
    }
  }
  for (const auto& [id, track] : unanswered) {
    add(id, track);
  }
  return rootFirst(std::move(candidates), leads);
}

std::vector<Blame::Candidate>::iterator Blame::rootsOfSilence(
    const std::vector<Candidate>& silent, std::vector<Candidate>& others, const Scorer& scorer,
    const RecentEvents& events, const Followers::Leads& leads) const {
  std::set<std::size_t> roots;  // components
  std::set<std::size_t> silent_ones;
  for (const Candidate& candidate : silent) {
    silent_ones.insert(componentOf(candidate));
  }
  const auto isWaitedFor = [&](const Candidate& other) {
    const std::size_t source = componentOf(other);
    return std::any_of(silent.begin(), silent.end(), [&](const Candidate& candidate) {
      const std::size_t victim = componentOf(candidate);
      return owesNothing(toOf(candidate), toOf(other), scorer, events) &&
             (upstream_->isUpstream(source, victim) || leads.count({source, victim}) > 0);
    });
  };
  const auto leadsRoot = [&](const Candidate& other) {
    return std::any_of(roots.begin(), roots.end(), [&](std::size_t root) {
      return leads.count({componentOf(other), root}) > 0;
    });
  };
  std::vector<const Candidate*> left;
  for (const Candidate& other : others) {
    if (!other.own || silent_ones.count(componentOf(other)) > 0) {
      continue;
    }
    if (isWaitedFor(other)) {
      roots.insert(componentOf(other));
    } else {
      left.push_back(&other);
    }
  }
  for (bool found = !roots.empty(); found;) {
    found = false;
    for (const Candidate* other : left) {
      found |= leadsRoot(*other) && roots.insert(componentOf(*other)).second;
    }
  }
  return std::stable_partition(others.begin(), others.end(), [&](const Candidate& other) {
    return roots.count(componentOf(other)) > 0;
  });
}

bool Blame::owesNothing(EventId follower, EventId leader, const Scorer& scorer,
                        const RecentEvents& events) const {
  const double gap = model_->meanGap(leader);
  const double usual = std::max(1.0, std::round(model_->meanGap(follower) / gap));
  const auto since = static_cast<double>(events.since(leader, follower));
  return since < usual ||
         (since == usual && static_cast<double>(scorer.heard().age(leader)) < gap / 2);
}

std::vector<Blame::Candidate> Blame::rootFirst(std::vector<Candidate> candidates,
                                               const Followers::Leads& leads) const {
  std::stable_sort(candidates.begin(), candidates.end(), likelier);
  std::vector<std::size_t> components;
  components.reserve(candidates.size());
  for (const Candidate& candidate : candidates) {
    components.push_back(componentOf(candidate));
  }
  std::vector<Candidate> ordered;
  const auto is_root = [&](std::size_t component, std::size_t other) {
    return upstream_->isUpstream(component, other) ||
           (leads.count({component, other}) > 0 && !upstream_->isUpstream(other, component));
  };
  for (const std::size_t next : evidence::rootFirst(components, is_root)) {
    ordered.push_back(candidates[next]);
  }
  return ordered;
}

std::vector<Blame::Candidate> Blame::unusual(const std::vector<double>& shares,
                                             const Scorer& scorer, const RecentEvents& events,
                                             const Followers::Leads& leads) const {
  struct Involved {
    double sum = 0;
    std::size_t track = 0;  // with the largest share
    double largest = 0;
    bool own = false;   // something is wrong with it, whatever the others do
    bool late = false;  // comes later after another one
  };
  std::map<std::string, Involved> components;
  std::map<EventId, std::size_t> lossy;  // tracks
  std::vector<std::size_t> late;         // the same
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const EventId to = model_->tracks()[track].to;
    const EventId from = model_->tracks()[track].from;
    const Finding finding = model_->finding(track);
    if (shares[track] < tuning_.least_share ||
        // An age that is usual has some share of its limit, too, and so has a request of now.
        (finding == Finding::kSilent && isUsualAge(track, shares, scorer)) ||
        (finding != Finding::kSilent && isAbsence(finding) &&
         shares[track] <= tuning_.near_limit)) {
      continue;
    }
    if (model_->tracks()[track].channel->kind() == Kind::kLossy) {
      lossy.emplace(to, track);
    }
    const double share = std::min(shares[track], tuning_.most_share);
    const bool other =
        finding == Finding::kBetween && model_->component(from) != model_->component(to);
    // That what comes before it is late makes its delays shorter.
    const bool earlier = other && suspectOf(track, scorer, events).reason.kind == Kind::kEarly;
    Involved& later = components[model_->component(to)];
    later.sum += earlier ? tuning_.share_of_other * share : share;
    if (other && !earlier) {
      later.late = true;
      late.push_back(track);
    }
    later.own |= shares[track] > tuning_.near_limit && finding != Finding::kSilent && !other;
    if (share > later.largest) {
      later.largest = share;
      later.track = track;
    }
    if (other) {
      components[model_->component(from)].sum += earlier ? share : tuning_.share_of_other * share;
    }
  }
  for (const std::size_t track : followers_.lateBefore(late, shares, scorer, events)) {
    Involved& involved = components[model_->component(model_->tracks()[track].to)];
    involved.late = true;
    if (involved.largest == 0) {
      involved.largest = tuning_.least_share;
      involved.track = track;
    }
  }
  std::array<std::vector<Candidate>, 3> groups;
  for (const auto& [name, involved] : components) {
    if (involved.largest > 0) {
      // What is lost makes gaps irregular, and not the other way round.
      const auto lost = lossy.find(model_->tracks()[involved.track].to);
      groups[involved.own    ? 0
             : involved.late ? 1
                             : 2]
          .push_back({lost == lossy.end() ? involved.track : lost->second, -involved.sum,
                      involved.own, involved.largest > 1});
    }
  }
  std::vector<Candidate> ordered;
  for (std::vector<Candidate>& group : groups) {
    group = rootFirst(std::move(group), leads);
    ordered.insert(ordered.end(), group.begin(), group.end());
  }
  return ordered;
}

bool Blame::isUsualAge(std::size_t track, const std::vector<double>& shares,
                       const Scorer& scorer) const {
  // Beyond its limit, it is not, whatever one start showed that did not count.
  return shares[track] <= 1 && logSurvival(model_->tracks()[track].to, scorer) >= rare_silence_;
}

double Blame::logSurvival(EventId id, const Scorer& scorer) const {
  return model_->logSurvival(id, scorer.heard().listenedFor(id));
}

bool Blame::isUsual(const Suspect& suspect) const {
  const Reason& reason = suspect.reason;
  if (reason.kind == Kind::kDied) {
    return reason.after.empty() && reason.value <= toSeconds(model_->longestGap(suspect.id));
  }
  return reason.usual_shortest <= reason.value && reason.value <= reason.usual_longest;
}

// Its age, if that alone is abnormal; else what is nearer to its limit: at half its rate, say, its
// age may be rare as well, but that is not what is wrong.
std::size_t Blame::trackOfSilence(EventId id, const std::vector<double>& shares,
                                  const Scorer& scorer, const RecentEvents& events) const {
  std::size_t most = 0;
  double largest = -1;
  for (std::size_t track = 0; track < shares.size(); ++track) {
    const Finding finding = model_->finding(track);
    const Track& watched = model_->tracks()[track];
    if (watched.to != id || watched.from != id || shares[track] <= 0 ||
        (finding == Finding::kUnusual &&
         suspectOf(track, scorer, events).reason.kind != Kind::kSlow)) {
      continue;
    }
    if (finding == Finding::kSilent && shares[track] > 1) {
      return track;
    }
    if (shares[track] > largest) {
      largest = shares[track];
      most = track;
    }
  }
  return most;
}

}  // namespace self_awareness::core::evidence
