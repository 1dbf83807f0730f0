#include "core/evidence/explain/explanation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

namespace self_awareness::core::evidence {
namespace {

/// Where all are silent, who they are is told, though none of them is to blame.
bool isNamed(const Excess& excess) {
  return excess.excused == Excused::kNo || excess.excused == Excused::kAllSilent;
}

}  // namespace

std::vector<Suspect> Explanation::suspects(const Unusual& window) const {
  std::vector<Suspect> suspects;
  const std::vector<Excess>& excesses = window.excesses;
  if (std::none_of(excesses.begin(), excesses.end(), isNamed)) {
    return suspects;
  }
  std::vector<Accused> accused(model_->components().size());
  for (const Excess& excess : excesses) {
    if (isNamed(excess)) {
      accuse(excess, window, accused);
    }
  }
  for (EventId id = 0; id < model_->size(); ++id) {
    Accused& each = accused[model_->componentIndex(id)];
    each.alive = each.alive || (window.heard().hasSeen(id) && each.main != nullptr &&
                                window.heard().stamps()[id] > each.latest);
  }
  const std::vector<Accused> ordered = order(std::move(accused), window);
  for (const Accused& each : ordered) {
    if (suspects.size() < kMostSuspects || each.abnormal) {
      Suspect suspect = suspectOf(*each.main, window);
      suspect.abnormal = each.abnormal;
      for (const Accused& other : ordered) {
        if (isRoot(other, each, window.causes)) {
          suspect.roots.insert(model_->components()[other.component]);
        }
      }
      if (each.main->finding() == Finding::kSilent && each.main->share > 1) {
        const double near = tuning_.near_limit * window.limits_of_silence[suspect.id];
        suspect.missed = window.heard().windowEnd() - window.heard().age(suspect.id) +
                         toNanoseconds(near);  // stalls do not count in its age
      }
      if (each.alive && suspect.reason.kind == Kind::kSilent) {
        suspect.reason.kind =
            suspect.reason.after.empty() ? Kind::kTopicSilent : Kind::kUnanswered;
      }
      const bool is_explained = std::any_of(suspects.begin(), suspects.end(),
                                            [](const Suspect& other) { return other.abnormal; });
      if (each.wrong == Wrong::kOther ? each.abnormal && !is_explained
                                      : each.abnormal || !isUsual(suspect)) {
        suspects.push_back(std::move(suspect));
      }
    }
  }
  return suspects;
}

Suspect Explanation::suspectOf(const Excess& excess, const Unusual& window) const {
  Suspect suspect;
  suspect.id = excess.id;
  suspect.component = model_->components()[excess.component];
  suspect.onset = excess.onset;
  window.scorer.explain(excess.track, window.events, suspect);
  return suspect;
}

bool Explanation::isAbsent(const Excess& excess, const Unusual& window) const {
  if (excess.share > 1 || excess.finding() != Finding::kSilent) {
    return excess.isAbsence() && excess.share > tuning_.near_limit;
  }
  const std::int64_t silence = window.heard().listenedFor(excess.id);
  return silence > model_->longestGap(excess.id) && model_->isRare(excess.id, silence);
}

void Explanation::accuse(const Excess& excess, const Unusual& window,
                         std::vector<Accused>& accused) const {
  const std::size_t from = model_->componentIndex(excess.from);
  Accused& later = accused[excess.component];
  Accused* unusual = &later;
  Wrong wrong = excess.share > tuning_.near_limit ? Wrong::kOwn : Wrong::kOther;
  if (excess.isAbsence()) {
    // An age that is usual has some share of its limit, too, and so has a request of now.
    if (!isAbsent(excess, window)) {
      return;
    }
    wrong = Wrong::kAbsent;
  } else if (excess.finding() == Finding::kBetween && from != excess.component) {
    // That what comes before it is late makes its delays shorter.
    if (suspectOf(excess, window).reason.kind == Kind::kEarly) {
      unusual = &accused[from];
      wrong = Wrong::kOther;
    } else if (wrong == Wrong::kOwn) {
      wrong = Wrong::kLate;
      later.after.insert(from);
    }
  }
  unusual->sum += excess.share;
  later.component = excess.component;
  later.abnormal = later.abnormal || excess.share > 1;
  // A silence that is abnormal says it all. Lost messages make gaps irregular, and not the other
  // way round.
  const auto rank = [&](const Excess& each, Wrong how) {
    const bool is_silent =
        how == Wrong::kAbsent && each.share > 1 && each.finding() == Finding::kSilent;
    const bool is_lossy = each.channel->kind() == Kind::kLossy;
    return std::tuple(!is_silent, std::max(how, Wrong::kOwn), !is_lossy, -each.share);
  };
  if (later.main == nullptr || rank(excess, wrong) < rank(*later.main, later.wrong)) {
    later.main = &excess;
    later.wrong = wrong;
  }
  if (wrong == Wrong::kAbsent) {
    const double usual = excess.finding() == Finding::kUnanswered ? 0 : model_->meanGap(excess.id);
    later.due = std::min(later.due, excess.onset + static_cast<std::int64_t>(usual));
    later.latest = std::max(later.latest, excess.onset + model_->longestGap(excess.id));
    later.near = later.near || excess.share > tuning_.near_limit;
    later.sure = later.sure || excess.share > 1;
  }
}

void Explanation::setUnlikelyAside(std::vector<Accused>& accused, const Unusual& window) const {
  auto left = std::partition(accused.begin(), accused.end(), [](const Accused& each) {
    return each.sure || each.wrong != Wrong::kAbsent;
  });
  for (auto found = left; found != accused.end();) {
    found = std::find_if(left, accused.end(), [&](const Accused& each) {
      return std::any_of(accused.begin(), left, [&](const Accused& victim) {
        // Where nobody knows who hears whom, it is who was missed first.
        const bool is_earlier = window.causes.areGuessed() && each.near &&
                                victim.wrong == Wrong::kAbsent && each.due < victim.due;
        return (victim.abnormal || victim.wrong == Wrong::kAbsent) &&
               (is_earlier || isRoot(each, victim, window.causes));
      });
    });
    if (found != accused.end()) {
      std::iter_swap(left++, found);
    }
  }
  std::for_each(left, accused.end(), [](Accused& each) { each.wrong = Wrong::kOther; });
}

void Explanation::setExplainedAside(std::vector<Accused>& accused) {
  std::map<std::size_t, Accused*> late;
  std::vector<Accused*> least_first;
  for (Accused& each : accused) {
    late[each.component] = &each;
    if (each.wrong == Wrong::kLate) {
      least_first.push_back(&each);
    }
  }
  std::stable_sort(least_first.begin(), least_first.end(),
                   [](const Accused* a, const Accused* b) { return a->sum < b->sum; });
  for (Accused* const victim : least_first) {
    const auto explains = [&](std::size_t component) {
      const auto cause = late.find(component);
      return cause != late.end() && cause->second->wrong < Wrong::kOther &&
             (cause->second->wrong < Wrong::kLate ||
              cause->second->after.size() > cause->second->after.count(victim->component));
    };
    if (std::all_of(victim->after.begin(), victim->after.end(), explains)) {
      victim->wrong = Wrong::kOther;
    }
  }
}

std::vector<Explanation::Accused> Explanation::order(std::vector<Accused> accused,
                                                     const Unusual& window) const {
  accused.erase(std::remove_if(accused.begin(), accused.end(),
                               [](const Accused& each) { return each.main == nullptr; }),
                accused.end());
  setUnlikelyAside(accused, window);
  setExplainedAside(accused);
  std::stable_sort(accused.begin(), accused.end(), [](const Accused& a, const Accused& b) {
    const auto of = [](const Accused& each) {
      return each.wrong == Wrong::kAbsent
                 ? std::tuple(each.wrong, each.alive, each.due, -each.sum)
                 : std::tuple(each.wrong, false, std::int64_t{0}, -each.sum);
    };
    return of(a) < of(b);
  });
  std::vector<Accused> ordered;
  for (auto first = accused.begin(); first != accused.end();) {
    const auto last = std::find_if(
        first, accused.end(), [&](const Accused& each) { return each.wrong != first->wrong; });
    const std::vector<Accused> group = rootFirst({first, last}, window);
    ordered.insert(ordered.end(), group.begin(), group.end());
    first = last;
  }
  // Who is at half its rate makes who follows it silent, though this owes it nothing.
  const auto absent_end = std::find_if(ordered.begin(), ordered.end(), [](const Accused& each) {
    return each.wrong != Wrong::kAbsent;
  });
  const std::vector<Accused> absent(ordered.begin(), absent_end);
  std::stable_partition(ordered.begin(), ordered.end(), [&](const Accused& each) {
    return each.wrong == Wrong::kOwn &&
           std::none_of(absent.begin(), absent.end(),
                        [&](const Accused& root) { return isRoot(root, each, window.causes); }) &&
           std::any_of(absent.begin(), absent.end(), [&](const Accused& victim) {
             return isRoot(each, victim, window.causes) &&
                    owesNothing(victim.main->id, each.main->id, window);
           });
  });
  return ordered;
}

std::vector<Explanation::Accused> Explanation::rootFirst(const std::vector<Accused>& accused,
                                                         const Unusual& window) const {
  std::vector<Accused> ordered;
  for (const std::size_t next :
       evidence::rootFirst(accused.size(), [&](std::size_t root, std::size_t victim) {
         return isRoot(accused[root], accused[victim], window.causes);
       })) {
    ordered.push_back(accused[next]);
  }
  return ordered;
}

bool Explanation::isRoot(const Accused& root, const Accused& victim, const Causes& causes) const {
  // Who fell silent only when the other one should have come is not why it did not; nor is who is
  // hardly silent, and should have come when the other one was missed already.
  const bool too_late = root.wrong == Wrong::kAbsent && victim.wrong == Wrong::kAbsent &&
                        (root.sure ? root.main->onset > victim.latest
                                   : root.main->onset > victim.due || root.due > victim.latest);
  return !too_late && causes.isRoot(root.component, victim.component);
}

bool Explanation::owesNothing(EventId follower, EventId leader, const Unusual& window) const {
  const double gap = model_->meanGap(leader);
  const double usual = std::max(1.0, std::round(model_->meanGap(follower) / gap));
  const auto since = static_cast<double>(window.events.since(leader, follower));
  return since < usual ||
         (since == usual && static_cast<double>(window.heard().age(leader)) < gap / 2);
}

bool Explanation::isUsual(const Suspect& suspect) const {
  const Reason& reason = suspect.reason;
  if (isSilence(reason.kind)) {
    return reason.after.empty() && reason.value <= toSeconds(model_->longestGap(suspect.id));
  }
  return reason.usual_shortest <= reason.value && reason.value <= reason.usual_longest;
}

}  // namespace self_awareness::core::evidence
