#include "core/evidence/blame/reasons.h"

#include <algorithm>
#include <optional>

namespace self_awareness::core::evidence {

std::int64_t Reasons::age(EventId id) const {
  return scorer_.windowEnd() - scorer_.lastSeen(id).value_or(scorer_.windowEnd());
}

Suspect Reasons::of(std::size_t track) const {
  Suspect suspect;
  suspect.id = model_.tracks().at(track).to;
  switch (model_.tracks()[track].channel) {
    case Channel::kOverdue:
      silence(suspect);
      break;
    case Channel::kFewer:
    case Channel::kMore:
      rate(suspect);
      break;
    case Channel::kDelay:
    case Channel::kSlowDelay:
      delay(track, suspect);
      break;
    case Channel::kAnswer:
      answer(track, suspect);
      break;
    case Channel::kDeadline:
      suspect.reason = Suspect::Reason::kUnanswered;
      suspect.other = toString(model_.vocabulary().at(model_.tracks()[track].from));
      if (model_.countsRequests(track)) {
        suspect.of = static_cast<std::size_t>(scorer_.waiting(track));
      } else {
        suspect.silence = scorer_.waiting(track);
      }
      break;
  }
  return suspect;
}

void Reasons::silence(Suspect& suspect) const {
  suspect.reason = Suspect::Reason::kSilent;
  suspect.silence = toSeconds(age(suspect.id));
  suspect.usual_shortest = model_.usualDelay(suspect.id, suspect.id, kUsualFrom);
  suspect.usual_longest = model_.usualDelay(suspect.id, suspect.id, kUsualTo);
  suspect.usual_gap = model_.meanGap(suspect.id) * 1e-9;
  suspect.longest_gap = toSeconds(model_.longestGap(suspect.id));
}

void Reasons::rate(Suspect& suspect) const {
  suspect.reason = Suspect::Reason::kRate;
  suspect.events = scorer_.recentCount(suspect.id);
  suspect.usual_fewest = std::max(model_.usualCount(suspect.id, -2), 0.0);
  suspect.usual_most = model_.usualCount(suspect.id, 2);
}

void Reasons::delay(std::size_t track, Suspect& suspect) const {
  const EventId from = model_.tracks()[track].from;
  suspect.reason = Suspect::Reason::kDelay;
  if (from != suspect.id) {
    suspect.other = toString(model_.vocabulary().at(from));
  }
  suspect.usual_shortest = model_.usualDelay(from, suspect.id, 0.05);
  suspect.usual_longest = model_.usualDelay(from, suspect.id, 0.95);
  if (const auto seen = hindsight_.delays(track, scorer_.cap(track))) {
    suspect.delay = seen->delay * 1e-9;
    suspect.usual_delay = seen->usual * 1e-9;
    suspect.scatter = seen->scatter ? *seen->scatter * 1e-9 : Suspect::kNone;
    suspect.times = seen->unusual;
    suspect.of = seen->number;
    suspect.lasted = secondsSince(seen->since);
  }
}

void Reasons::answer(std::size_t track, Suspect& suspect) const {
  const EventId from = model_.tracks()[track].from;
  suspect.reason = Suspect::Reason::kAnswer;
  suspect.other = toString(model_.vocabulary().at(from));
  const Statistics& training = model_.statistics();
  suspect.usual_share = 1 - static_cast<double>(training.answers(from, suspect.id)) /
                                static_cast<double>(training.type(from).gaps);
  if (const auto seen = hindsight_.answers(track, scorer_.cap(track))) {
    suspect.times = seen->missed;
    suspect.of = seen->asked;
    suspect.lasted = secondsSince(seen->since);
  }
}

double Reasons::secondsSince(std::int64_t stamp) const {
  return toSeconds(scorer_.windowEnd() - stamp);
}

}  // namespace self_awareness::core::evidence
